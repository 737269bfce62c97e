#include "core/render/bone/bone_scene.h"

#include <GL/glcorearb.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/geometry/mesh/procedural.h"
#include "core/render/bone/bone_dust.h"
#include "core/render/bone/bone_mesh.h"
#include "core/render/bone/bone_palette.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/gl/offscreen.h"
#include "tests/core/bone/surface/surface_checks.h"
#include "tests/core/render/bone/bone_changes.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::bone_scene_test {
namespace {

using bone::BoneModel;
using bone::BoneVolume;
using bone::Voxel;

constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr double kAspect = static_cast<double>(kWidth) / kHeight;

BoneStyle plain_style() {
  BoneStyle style;
  style.background = {0.0, 0.0, 0.0};
  style.background_visibility = false;
  style.smooth_edges = false;
  return style;
}

/// A scene in a context of its own.
struct Stage {
  explicit Stage(const BoneModel& model, const BoneStyle& style = plain_style())
      : context(kWidth, kHeight),
        depths(
            std::make_shared<bone::StructureDepths>(model, bone::all_but_bone(model.structures))),
        scene(context.gl(), style, model.structures, depths) {}
  /// @throws RunError where OpenGL reports an error
  Image draw(const BoneFrame& frame) {
    context.make_current();
    scene.draw(frame, kWidth, kHeight);
    return context.read();
  }
  OffscreenContext context;
  std::shared_ptr<const bone::StructureDepths> depths;
  BoneScene scene;
};

Eigen::Vector3d middle_of(const BoneModel& model) {
  return model.grid.origin +
         Eigen::Vector3d::Constant(0.5 * model.grid.spacing * (model.grid.size[0] - 1));
}

/// The eye at +z of the middle.
BoneFrame frame_of(const BoneModel& model, const BoneVolume& volume, double distance = 0.2) {
  BoneFrame frame;
  frame.camera.target = middle_of(model);
  frame.camera.eye = frame.camera.target + Eigen::Vector3d(0, 0, distance);
  frame.bones = {{1, &volume, Eigen::Isometry3d::Identity()}};
  return frame;
}

bool is_dark(const Image& image, int x, int y) { return pixel(image, x, y).maxCoeff() < 1.0; }

int count_lit(const Image& image) {
  int lit = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      lit += !is_dark(image, x, y);
    }
  }
  return lit;
}

int count_different(const Image& a, const Image& b) {
  int different = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      different += (pixel(a, x, y) - pixel(b, x, y)).cwiseAbs().maxCoeff() > 12.0;
    }
  }
  return different;
}

TEST(BoneSceneTest, ABallCoversTheDiscThatItsRadiusAndDistanceSay) {
  const BoneModel model = bone::ball_model(40, 16.0);
  const BoneVolume volume(model);
  Stage stage(model);
  const Image image = stage.draw(frame_of(model, volume));
  // A sphere of radius r at distance d covers the cone of asin(r / d).
  const double radius = 0.001 * (16.0 - 1.0 / 16.0);  // smoothed with variance 1
  const double disc = 0.5 * kHeight * std::tan(std::asin(radius / 0.2)) / std::tan(0.35 / 2);
  EXPECT_NEAR(count_lit(image), M_PI * disc * disc, 0.02 * M_PI * disc * disc);
  for (int angle = 0; angle < 24; ++angle) {
    const auto at = [&](double r) {
      return Eigen::Vector2i(static_cast<int>(0.5 * kWidth + r * std::cos(angle * M_PI / 12)),
                             static_cast<int>(0.5 * kHeight + r * std::sin(angle * M_PI / 12)));
    };
    EXPECT_FALSE(is_dark(image, at(disc - 2).x(), at(disc - 2).y()));
    EXPECT_TRUE(is_dark(image, at(disc + 2).x(), at(disc + 2).y()));
  }
  EXPECT_GT(pixel(image, kWidth / 2, kHeight / 2).x(),
            1.5 * pixel(image, kWidth / 2, static_cast<int>(kHeight / 2 + 0.95 * disc)).x())
      << "what faces the light is brighter";
}

TEST(BoneSceneTest, TheVisibleArrayShowsWhatTheCompleteOneShows) {
  const BoneModel model = bone::model_of(48, [](const Voxel& v) {
    const double bumps =
        3.0 * std::sin(0.7 * v.x()) * std::sin(0.9 * v.y()) * std::sin(0.8 * v.z());
    return (v.cast<double>() - Eigen::Vector3d::Constant(23.5)).norm() + bumps < 18.0 ? 1 : 0;
  });
  BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  const Image complete = stage.draw(frame);
  EXPECT_FALSE(stage.scene.figures().visible_only) << "the camera has only come";
  EXPECT_EQ(stage.scene.figures().drawn, stage.scene.figures().triangles);
  const Image visible = stage.draw(frame);
  EXPECT_TRUE(stage.scene.figures().visible_only);
  EXPECT_LT(10 * stage.scene.figures().drawn, 7 * stage.scene.figures().triangles);
  // A triangle that faces the eye while none of its vertices' normals do lies at an outline.
  EXPECT_LT(count_different(complete, visible), 0.002 * kWidth * kHeight);
  frame.camera = gone_round(frame.camera, 0.1);
  stage.draw(frame);
  EXPECT_FALSE(stage.scene.figures().visible_only) << "it moves again";
}

TEST(BoneSceneTest, WhatIsDrilledAtRestLooksAsIfDrawnAnew) {
  const BoneModel model = bone::ball_model(48, 20.0);
  BoneStyle style = plain_style();
  for (const bool thread : {false, true}) {
    BoneVolume volume(model);
    style.background_visibility = thread;
    Stage stage(model, style);
    const BoneFrame frame = frame_of(model, volume);
    stage.draw(frame);
    do {  // until the pass has come to its end
      stage.draw(frame);
    } while (!stage.scene.figures().visible_only);
    for (int step = 0; step < 12; ++step) {
      for (int k = -4; k <= 4; ++k) {
        for (int j = -4; j <= 4; ++j) {
          for (int i = -4; i <= 4; ++i) {
            const std::int32_t at = volume.address(Voxel(14 + 2 * step + i, 24 + j, 42 + k));
            if (at != 0 && i * i + j * j + k * k <= 16) {
              volume.take(at, 1.0F);
            }
          }
        }
      }
      const Image image = stage.draw(frame);
      if (step > 0) {
        EXPECT_LT(stage.scene.figures().uploaded, 60'000U) << "only what changed is sent";
      }
      Stage fresh(model);
      EXPECT_LT(count_different(image, fresh.draw(frame)), 0.002 * kWidth * kHeight);
    }
  }
}

TEST(BoneSceneTest, AStereoPairHasTheDisparityOfItsGeometry) {
  const BoneModel model = bone::ball_model(16, 4.0);
  const BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  frame.stereo = StereoPair{0.02, 0.3};
  const Image image = stage.draw(frame);
  const auto middle = [&](int from) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = from; x < from + kWidth / 2; ++x) {
        if (!is_dark(image, x, y)) {
          sum += x + 0.5 - from;
          ++count;
        }
      }
    }
    EXPECT_GT(count, 100);
    return sum / count;
  };
  const double pixels = 0.5 * kHeight / std::tan(0.35 / 2);  // at distance 1
  EXPECT_NEAR(middle(kWidth / 2) - middle(0), pixels * 0.02 * (1 / 0.3 - 1 / 0.2), 0.7);
}

TEST(BoneSceneTest, AStructureShowsThroughThinBoneAndNotThroughThick) {
  // A yellow rod along x, 1 and 7 voxels under the upper face.
  const auto slab = [](int rod) {
    return bone::model_of(40, [rod](const Voxel& v) {
      if (v.x() < 4 || v.x() > 35 || v.y() < 4 || v.y() > 35 || v.z() < 4 || v.z() > 30) {
        return 0;
      }
      return std::abs(v.y() - 20) <= 1 && std::abs(v.z() - rod) <= 1 ? 2 : 1;
    });
  };
  const auto yellowness = [](const Eigen::Vector3d& rgb) {
    return rgb.x() / std::max(rgb.z(), 1.0);
  };
  for (const auto& [rod, shows] : {std::pair{28, true}, std::pair{22, false}}) {
    const BoneModel model = slab(rod);
    const BoneVolume volume(model);
    Stage stage(model);
    BoneFrame frame = frame_of(model, volume, 0.15);
    const Image image = stage.draw(frame);
    const double over = yellowness(pixel(image, kWidth / 2, kHeight / 2));
    const double beside = yellowness(pixel(image, kWidth / 2, kHeight / 2 - 40));
    EXPECT_FALSE(is_dark(image, kWidth / 2, kHeight / 2 - 40));
    if (shows) {
      EXPECT_GT(over, 1.15 * beside);
    } else {
      EXPECT_NEAR(over, beside, 0.02);
    }
  }
}

TEST(BoneSceneTest, ColoursFollowDensityLabelAndDepth) {
  const BoneStyle style;
  const std::vector<bone::Structure> structures{
      {"", {0, 0, 0}}, {"bone", {1, 1, 1}}, {"facial nerve", {1.0, 0.0, 0.0}}};
  const BonePalette palette(style, structures);
  bone::SurfaceVertex vertex;
  vertex.label = 1;
  vertex.density = 255;
  EXPECT_EQ(palette.of(vertex)[0], std::lround(255 * style.hard_bone.red));
  vertex.density = 0;
  EXPECT_EQ(palette.of(vertex)[2], std::lround(255 * style.soft_bone.blue));
  vertex.near_label = 2;
  int last = 0;
  for (int depth = 0; depth < 256; ++depth) {
    vertex.near_depth = static_cast<std::uint8_t>(depth);
    const double share = style.through_share * std::exp(-25e-6 * depth / style.through_length);
    EXPECT_NEAR(palette.of(vertex)[1], 255 * style.soft_bone.green * (1.0 - share), 1.0);
    EXPECT_GE(palette.of(vertex)[1], last);
    last = palette.of(vertex)[1];
  }
  vertex.label = 2;
  EXPECT_EQ(palette.of(vertex), (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
}

TEST(BoneSceneTest, PiecesToolsAndDustAreWhereTheirPosesSay) {
  const BoneModel model = bone::ball_model(16, 4.0);
  const BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  const double pixels = 0.5 * kHeight / std::tan(0.35 / 2) / 0.2;  // to a metre at the target
  frame.bones[0].pose.translation().x() = 0.02;
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(geometry::make_sphere(0.004, 8)),
                          Eigen::Isometry3d::Identity(),
                          {1.0, 0.0, 0.0}});
  frame.meshes[0].pose.translation() = frame.camera.target - Eigen::Vector3d(0.02, 0, 0);
  frame.dust.push_back(
      {(frame.camera.target + Eigen::Vector3d(0, 0.012, 0)).cast<float>(), 0.006F, 0.9F});
  const Image image = stage.draw(frame);
  const int right = static_cast<int>(kWidth / 2 + 0.02 * pixels);
  const int left = static_cast<int>(kWidth / 2 - 0.02 * pixels);
  const int above = static_cast<int>(kHeight / 2 - 0.012 * pixels);
  EXPECT_GT(pixel(image, right, kHeight / 2).y(), 100.0);
  EXPECT_GT(pixel(image, left, kHeight / 2).x(), 100.0);
  EXPECT_LT(pixel(image, left, kHeight / 2).y(), 60.0) << "a red tool";
  double brightest = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kWidth / 2 - 20; x < kWidth / 2 + 20; ++x) {
      const double away = std::hypot(x - kWidth / 2, y - above);
      brightest = std::max(brightest, pixel(image, x, y).x());
      EXPECT_TRUE(away < 1.1 * 0.006 * pixels + 1.0 || is_dark(image, x, y)) << x << ", " << y;
    }
  }
  EXPECT_GT(brightest, 0.8 * 255 * BoneStyle{}.dust.red);
  EXPECT_TRUE(is_dark(image, kWidth / 2, kHeight / 2)) << "the bone went away";
  frame.bones.clear();
  frame.meshes.clear();
  frame.dust.clear();
  EXPECT_EQ(count_lit(stage.draw(frame)), 0);
}

TEST(BoneSceneTest, BloodHidesWhatItCovers) {
  const BoneModel model = bone::ball_model(30, 12.0);
  const BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  const auto redness = [&](int x) {
    const auto colour = pixel(stage.draw(frame), x, kHeight / 2);
    return colour.x() / std::max(1.0, colour.y());
  };
  const double bare = redness(kWidth / 2);
  const double beside = redness(kWidth / 2 + 12);
  for (int i = 0; i < 60; ++i) {  // a pool before the bone
    const Eigen::Vector3d at(0.0004 * (i % 8 - 4), 0.0004 * (i / 8 - 4), 0.016);
    frame.blood.push_back({(frame.camera.target + at).cast<float>(), 0.0009F, 1.0F});
  }
  EXPECT_GT(redness(kWidth / 2), 4.0 * bare);
  EXPECT_NEAR(redness(kWidth / 2 + 12), beside, 0.05 * beside);
  frame.blood.clear();
  EXPECT_NEAR(redness(kWidth / 2), bare, 1e-9) << "sucked away";
}

bool is_same(const Image& a, const Image& b) { return a.rgb == b.rgb; }

/// A ball under a burr, with all that a style has to draw.
BoneFrame busy_frame(const BoneModel& model, const BoneVolume& volume) {
  BoneFrame frame = frame_of(model, volume);
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(burr_mesh(0.006, 0.002, 0.08)),
                          Eigen::Isometry3d::Identity(),
                          {0.7, 0.7, 0.7},
                          burr_shadow(0.006, 0.002, 0.08)});
  frame.meshes[0].pose.translation() = frame.camera.target + Eigen::Vector3d(0, 0.004, 0.02);
  frame.dust.push_back(
      {(frame.camera.target + Eigen::Vector3d(0, -0.005, 0.016)).cast<float>(), 0.004F, 0.8F});
  return frame;
}

TEST(BoneSceneTest, LessQualityLeavesOutAndAllOfItComesBack) {
  const BoneModel model = bone::ball_model(30, 12.0);
  const BoneVolume volume(model);
  Stage stage(model, BoneStyle{});
  const BoneFrame frame = busy_frame(model, volume);
  const Image full = stage.draw(frame);
  stage.scene.set_quality(Quality::kShaded);
  const Image shaded = stage.draw(frame);
  stage.scene.set_quality(Quality::kPlain);
  const Image plain = stage.draw(frame);
  EXPECT_GT(count_different(full, shaded), 50);
  EXPECT_GT(count_different(shaded, plain), 500);
  BoneStyle bare;
  bare.smooth_edges = false;
  EXPECT_TRUE(is_same(shaded, Stage(model, bare).draw(frame)));
  for (const Quality quality : {Quality::kShaded, Quality::kFull}) {
    stage.scene.set_quality(quality);
    EXPECT_TRUE(is_same(stage.draw(frame), quality == Quality::kFull ? full : shaded));
  }
}

TEST(BoneSceneTest, APictureOfAMovingCameraIsThatOfOneAtRestIfItIsAskedFor) {
  const BoneModel model = bone::ball_model(30, 12.0);
  const BoneVolume volume(model);
  BoneStyle style;
  style.shades_moving = true;
  Stage moving(model, style);
  BoneFrame frame = busy_frame(model, volume);
  for (int i = 0; i < 3; ++i) {
    frame.camera.eye.x() += 0.01;
    const Image at_rest = Stage(model, style).draw(frame);
    EXPECT_TRUE(is_same(moving.draw(frame), at_rest)) << i;
  }
}

TEST(BoneSceneTest, GrainsOfDustAreTheSameEachTimeAndMakeNoLattice) {
  const BoneModel model = bone::ball_model(16, 4.0);
  const BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  frame.bones.clear();
  constexpr int kCells = 8;
  constexpr double kApart = 0.004;
  for (int i = 0; i < kCells * kCells; ++i) {
    const Eigen::Vector3d off(i % kCells - 3.5, i / kCells - 3.5, 0.0);
    frame.dust.push_back(
        {(frame.camera.target + kApart * off).cast<float>(), static_cast<float>(kApart), 0.8F});
  }
  const Image image = stage.draw(frame);
  EXPECT_EQ(count_different(image, stage.draw(frame)), 0);
  // A lattice would look the same one cell on: here most of what is lit there is not.
  const auto cell =
      static_cast<int>(std::lround(kApart * 0.5 * kHeight / std::tan(0.35 / 2) / 0.2));
  int lit = 0;
  int same = 0;
  for (int y = kHeight / 2 - 2 * cell; y < kHeight / 2 + 2 * cell; ++y) {
    for (int x = kWidth / 2 - 3 * cell; x < kWidth / 2 + 2 * cell; ++x) {
      lit += is_dark(image, x, y) ? 0 : 1;
      same += (pixel(image, x, y) - pixel(image, x + cell, y)).cwiseAbs().maxCoeff() < 8.0;
    }
  }
  EXPECT_GT(lit, 5 * cell * 4 * cell / 2) << "it covers most of the place";
  EXPECT_LT(same, 5 * cell * 4 * cell / 4);
}

TEST(BoneSceneTest, ATranslucentPlaneLetsBoneThroughAndHidesNothingBehindTheBone) {
  const BoneModel model = bone::ball_model(30, 12.0);
  const BoneVolume volume(model);
  Stage stage(model);
  BoneFrame frame = frame_of(model, volume);
  const Eigen::Vector3d bare = pixel(stage.draw(frame), kWidth / 2, kHeight / 2);
  SceneMesh plane{std::make_shared<geometry::Mesh>(plane_mesh(0.03, 0.03)),
                  Eigen::Isometry3d::Identity(),
                  {0.0, 0.0, 1.0, 0.4}};
  plane.pose.translation() = frame.camera.target + Eigen::Vector3d(0, 0, 0.02);
  frame.meshes = {plane};
  const Eigen::Vector3d before = pixel(stage.draw(frame), kWidth / 2, kHeight / 2);
  EXPECT_NEAR(before.x(), 0.6 * bare.x() + 0.4 * 255 * 0.1, 8.0);
  EXPECT_GT(before.z() / before.x(), 1.2 * bare.z() / bare.x());
  frame.meshes[0].pose.translation() = frame.camera.target - Eigen::Vector3d(0, 0, 0.02);
  EXPECT_EQ(pixel(stage.draw(frame), kWidth / 2, kHeight / 2), bare);
}

/// A closed mesh that is seen from outside.
double volume_of(const geometry::Mesh& mesh) {
  double six = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return six / 6.0;
}

TEST(BoneSceneTest, BurrsOfEveryShapeAreDrawnAsTheyAre) {
  using bone::BurrForm;
  const bone::BurrDimensions thin{BurrForm::kCylinder, 0.001, 0.006, 0.0};
  const auto look_of = [](const bone::BurrDimensions& head) {
    return BurrLook{head, false, true, 0.001, 0.02, 0.08};
  };
  for (const bone::BurrDimensions& head :
       {bone::BurrDimensions{BurrForm::kCylinder, 0.002, 0.006, 0.0},
        bone::BurrDimensions{BurrForm::kCone, 0.003, 0.006, 0.001},
        bone::BurrDimensions{BurrForm::kPear, 0.004, 0.006, 0.002}}) {
    const bone::BurrShape shape(head);
    BurrLook look = look_of(head);
    const geometry::Mesh smooth = burr_mesh(look);
    look.cutting = true;
    const geometry::Mesh bladed = burr_mesh(look);
    // Shaft and handle are the same.
    EXPECT_NEAR(volume_of(smooth) - volume_of(burr_mesh(look_of(thin))),
                shape.volume() - bone::BurrShape(thin).volume(), 0.01 * shape.volume());
    EXPECT_LT(volume_of(bladed), volume_of(smooth) - 0.05 * shape.volume()) << "grooves";
    for (const geometry::Mesh* mesh : {&smooth, &bladed}) {
      for (const Eigen::Vector3d& vertex : mesh->vertices) {
        EXPECT_TRUE(vertex.z() >= shape.half_length() - 1e-12 ||
                    shape.nearest(vertex).distance < 1e-9)
            << "within its shape";
      }
    }
  }
  EXPECT_THROW(burr_mesh(look_of({BurrForm::kCylinder, 0.002, 0.09, 0.0})), std::invalid_argument);
}

TEST(BoneSceneTest, ToolMeshesAreClosedAndOutwards) {
  // A tube of a regular polygon of 32 sides: its area is 16 sin(2 pi / 32) of the radius squared.
  const double polygon = 16.0 * std::sin(2.0 * M_PI / 32);
  EXPECT_NEAR(volume_of(suction_mesh(0.002, 0.003, 0.1)),
              polygon * (0.0015 * 0.0015 - 0.001 * 0.001) * 0.1, 1e-12);
  EXPECT_GT(volume_of(burr_mesh(0.006, 0.002, 0.08)), 4.0 / 3.0 * M_PI * std::pow(0.003, 3) * 0.95);
  for (const bool clockwise : {true, false}) {
    const geometry::Mesh burr = cutting_burr_mesh(0.006, 0.002, 0.08, clockwise);
    const double ball = 4.0 / 3.0 * M_PI * std::pow(0.003, 3);
    const double handle =
        volume_of(burr_mesh(0.006, 0.002, 0.08)) - volume_of(geometry::make_sphere(0.003, 12));
    EXPECT_LT(volume_of(burr) - handle, 0.92 * ball) << "grooves";
    EXPECT_GT(volume_of(burr) - handle, 0.6 * ball) << "outwards";
    for (const Eigen::Vector3d& vertex : burr.vertices) {
      EXPECT_TRUE(vertex.norm() < 0.003 + 1e-12 || vertex.z() > 0.003) << "within its diameter";
    }
  }
  EXPECT_NEAR(volume_of(plane_mesh(0.1, 0.2)), 0.0, 1e-15);
  for (const LitCorner& corner : lit_corners(geometry::make_sphere(0.01, 6))) {
    const Eigen::Vector3f place = Eigen::Map<const Eigen::Vector3f>(corner.place.data());
    const Eigen::Vector3f normal = Eigen::Map<const Eigen::Vector3f>(corner.normal.data());
    EXPECT_GT(normal.dot(place.normalized()), 0.98F);
  }
  EXPECT_THROW(burr_mesh(0.0, 0.002, 0.08), std::invalid_argument);
  EXPECT_THROW(suction_mesh(0.003, 0.002, 0.1), std::invalid_argument);
  EXPECT_THROW(plane_mesh(0.1, -1.0), std::invalid_argument);
  ToolState tool;
  tool.tip.position = {0.1, 0.2, 0.3};
  tool.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  EXPECT_TRUE((pose_of(tool) * Eigen::Vector3d(0, 0, 1)).isApprox(tool.tip.position + tool.axis()));
}

TEST(BoneSceneTest, DustIsDrawnFromTheBack) {
  const std::vector<bone::DustQuad> dust{
      {{0, 0, 0.1F}, 1, 1}, {{0, 0, 0.3F}, 1, 1}, {{0, 0, -0.2F}, 1, 1}};
  EXPECT_EQ(back_to_front(dust, {0, 0, 1}), (std::vector<std::uint32_t>{2, 0, 1}));
}

TEST(BoneSceneTest, AFrameThatCannotBeDrawnIsRefused) {
  const BoneModel model = bone::ball_model(8, 2.0);
  const BoneVolume volume(model);
  Stage stage(model);
  const BoneFrame good = frame_of(model, volume);
  BoneFrame bad = good;
  bad.camera.eye = bad.camera.target;
  EXPECT_THROW(stage.draw(bad), std::invalid_argument);
  bad = good;
  bad.bones.push_back(bad.bones[0]);
  EXPECT_THROW(stage.draw(bad), std::invalid_argument);
  bad = good;
  bad.bones[0].volume = nullptr;
  EXPECT_THROW(stage.draw(bad), std::invalid_argument);
  bad = good;
  bad.meshes.push_back({});
  EXPECT_THROW(stage.draw(bad), std::invalid_argument);
  EXPECT_NO_THROW(stage.draw(good));
}

TEST(GlBufferTest, RunsCoverEveryNumberAndFewOthers) {
  std::vector<std::uint32_t> numbers{40, 3, 4, 5, 5, 9, 41, 100};
  const auto ranges = ranges_of(numbers, 3);
  ASSERT_EQ(ranges.size(), 3U);
  EXPECT_EQ(ranges[0].first, 3U);
  EXPECT_EQ(ranges[0].count, 7U);
  EXPECT_EQ(ranges[1].first, 40U);
  EXPECT_EQ(ranges[1].count, 2U);
  EXPECT_EQ(ranges[2].first, 100U);
  EXPECT_EQ(ranges[2].count, 1U);
}

}  // namespace
}  // namespace haptrial::render::bone_scene_test
