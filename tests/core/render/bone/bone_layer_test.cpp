#include "core/render/bone/bone_layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/random.h"
#include "core/bone/surface/surface.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/bone/surgical_field.h"
#include "core/render/gl/offscreen.h"
#include "core/render/gl/window.h"
#include "tests/core/render/bone/bone_changes.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/support/virtual_display.h"

namespace haptrial::render::bone_layer_test {
namespace {

using bone::BoneModel;
using bone::BoneVolume;
using bone::Voxel;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// A scene in a context of its own.
struct Stage {
  Stage(const BoneModel& model, bool kept)
      : context(kWidth, kHeight),
        depths(
            std::make_shared<bone::StructureDepths>(model, bone::all_but_bone(model.structures))),
        scene(context.gl(), style_of(kept), model.structures, depths) {}
  static BoneStyle style_of(bool kept) {
    BoneStyle style;
    style.kept_layer = kept;
    style.vignette = 0.6;
    return style;
  }
  Image draw(const BoneFrame& frame, int width = kWidth, int height = kHeight) {
    context.make_current();
    scene.draw(frame, width, height);
    return context.read();
  }
  OffscreenContext context;
  std::shared_ptr<const bone::StructureDepths> depths;
  BoneScene scene;
};

/// Draws every frame twice: what rests is kept, and all is drawn in every frame.
struct Both {
  explicit Both(const BoneModel& model) : kept(model, true), all(model, false) {}
  void draw(const BoneFrame& frame, const char* what, int step, int width = kWidth,
            int height = kHeight) {
    const Image one = kept.draw(frame, width, height);
    const Image other = all.draw(frame, width, height);
    ASSERT_EQ(one.rgb.size(), other.rgb.size());
    const auto differ = std::mismatch(one.rgb.begin(), one.rgb.end(), other.rgb.begin());
    const auto at = (differ.first - one.rgb.begin()) / 3;
    ASSERT_TRUE(differ.first == one.rgb.end())
        << what << ", step " << step << ": pixel " << at % kWidth << ", " << at / kWidth;
    ASSERT_EQ(all.scene.figures().pixels,
              static_cast<std::size_t>(frame.stereo ? width / 2 * 2 : width) *
                  static_cast<std::size_t>(height));
  }
  std::size_t pixels() const { return kept.scene.figures().pixels; }
  Stage kept;
  Stage all;
};

BoneFrame frame_of(const BoneModel& model, const BoneVolume& volume) {
  const geometry::VoxelGrid& grid = model.grid;
  BoneFrame frame;
  frame.camera.target = grid.centre(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
  frame.camera.eye = frame.camera.target + Eigen::Vector3d(0.03, 0.05, 0.15);
  frame.bones = {{1, &volume, Eigen::Isometry3d::Identity()}};
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(burr_mesh(0.006, 0.002, 0.08)),
                          Eigen::Isometry3d::Identity()});
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(plane_mesh(0.03, 0.03)),
                          Eigen::Isometry3d::Identity(),
                          {0.2, 0.4, 1.0, 0.4}});
  frame.meshes.front().casts = burr_shadow(0.006, 0.002, 0.08);
  frame.scenery = surgical_field(model, Eigen::Isometry3d::Identity(), frame.camera);
  return frame;
}

/// Tools and dust go on every frame.
void move_tools(BoneFrame& frame, RandomStream& random) {
  const auto near = [&] {
    return Eigen::Vector3d(frame.camera.target + Eigen::Vector3d(random.uniform(-0.02, 0.02),
                                                                 random.uniform(-0.02, 0.02),
                                                                 random.uniform(-0.02, 0.02)));
  };
  for (SceneMesh& mesh : frame.meshes) {
    mesh.pose.translation() = near();
  }
  frame.dust.resize(30);
  for (bone::DustQuad& quad : frame.dust) {
    quad.position = near().cast<float>();
  }
}

class BoneLayerTest : public testing::TestWithParam<bool> {};  // a stereo pair

/// Soft below, bone above; the eye looks at an edge of both.
BoneModel half_soft(int size) {
  BoneModel model = bone::model_of(
      size, [&](const Voxel& v) -> std::uint8_t { return v.y() < size / 2 ? 2 : 1; });
  model.structures.resize(3);
  model.structures[1] = {"bone", {}};
  model.structures[2] = {"dura", {0.3, 0.4, 0.8}, 1.0, true};
  return model;
}

/// A dent that deepens, wanders and goes is drawn by drawing a part of the picture.
TEST_P(BoneLayerTest, ADentIsDrawnIntoThePictureThatIsKept) {
  const BoneModel model = half_soft(40);
  BoneVolume volume(model);
  Both both(model);
  BoneFrame frame = frame_of(model, volume);
  if (GetParam()) {
    frame.stereo = StereoPair{0.01, {}};
  }
  frame.camera.eye = frame.camera.target + Eigen::Vector3d(0.01, 0.02, 0.15);
  frame.meshes.clear();
  const double top = model.grid.origin.z() + model.grid.spacing * (model.grid.size[2] - 1);
  for (int step = 0; step < 3; ++step) {
    ASSERT_NO_FATAL_FAILURE(both.draw(frame, "at rest", step));
  }
  const Image before = both.kept.draw(frame);
  for (int step = 1; step <= 12; ++step) {
    bone::Dent& dent = frame.bones.front().dents[static_cast<std::size_t>(step / 7)];
    frame.bones.front().dents = {};
    dent = {2,
            {frame.camera.target.x() + 3e-4 * step, frame.camera.target.y() - 0.004, top},
            Eigen::Vector3d::UnitZ(),
            1.5e-4 * step,
            0.002};
    ASSERT_NO_FATAL_FAILURE(both.draw(frame, "a dent", step));
    EXPECT_GT(both.pixels(), 0U) << step;
    EXPECT_LT(both.pixels(), std::size_t{kWidth * kHeight / 2}) << step;
  }
  EXPECT_NE(both.kept.draw(frame).rgb, before.rgb) << "it is seen";
  frame.bones.front().dents[1].label = 3;
  ASSERT_NO_FATAL_FAILURE(both.draw(frame, "of a structure that is not there", 0));
  EXPECT_EQ(both.kept.draw(frame).rgb, before.rgb);
}

TEST_P(BoneLayerTest, APictureThatIsKeptIsThatOfAFullRedraw) {
  RandomStream random(12, "layer");
  const BoneModel model = bumpy(40);
  BoneVolume volume(model);
  const BoneModel small = bone::ball_model(40, 6.0);
  BoneVolume piece(small);
  Both both(model);
  BoneFrame frame = frame_of(model, volume);
  if (GetParam()) {
    frame.stereo = StereoPair{0.01, {}};
  }
  std::vector<std::size_t> pixels;
  const auto next = [&](const char* what, int step) {
    move_tools(frame, random);
    both.draw(frame, what, step);
    pixels.push_back(both.pixels());
  };
  for (int round = 0; round < 3; ++round) {
    for (int step = 0; step < 3; ++step) {
      frame.camera = gone_round(frame.camera, 0.1);
      change_at_random(volume, random);
      ASSERT_NO_FATAL_FAILURE(next("a camera that moves", step));
      EXPECT_EQ(pixels.back(), static_cast<std::size_t>(kWidth * kHeight));
    }
    ASSERT_NO_FATAL_FAILURE(next("come to rest", 0));
    ASSERT_NO_FATAL_FAILURE(next("at rest", 0));
    EXPECT_EQ(pixels.back(), 0U) << "only tools move";
    pixels.clear();
    for (int step = 0; step < 40; ++step) {
      change_at_random(volume, random);
      ASSERT_NO_FATAL_FAILURE(next("a carving", step));
    }
    std::sort(pixels.begin(), pixels.end());
    EXPECT_LT(pixels[20], std::size_t{kWidth * kHeight / 3}) << "the half of the carvings";
    EXPECT_GT(pixels[20], 500U);
    frame.bones.push_back({2, &piece, Eigen::Isometry3d::Identity()});
    for (int step = 0; step < 12; ++step) {  // moves, rests, is changed
      if (step < 4) {                        // in front of the bone, at its edge
        const Eigen::Vector3d aside(0.008 + 0.002 * step, 0.006, 0.014);
        frame.bones[1].pose = Eigen::Translation3d(frame.camera.target + aside) *
                              Eigen::AngleAxisd(0.3 * step, Eigen::Vector3d::UnitX()) *
                              Eigen::Translation3d(-frame.camera.target);
      } else if (step > 7) {
        change(piece, Voxel(16 + step, 20, 20), 3, 1.0F);
        change_at_random(volume, random);
      }
      ASSERT_NO_FATAL_FAILURE(next("a piece", step));
      if (step == 6 || step == 7) {
        EXPECT_EQ(pixels.back(), 0U) << "all rests again";
      }
    }
    frame.bones.pop_back();
    ASSERT_NO_FATAL_FAILURE(next("a piece that is gone", 0));
    EXPECT_GT(pixels.back(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(MonoAndStereo, BoneLayerTest, testing::Bool());

TEST(BoneLayerScenesTest, SizeFieldOfViewAndStereoBringANewPicture) {
  const BoneModel model = bumpy(24);
  const BoneVolume volume(model);
  Both both(model);
  BoneFrame frame = frame_of(model, volume);
  const auto twice = [&](const char* what, int width, int height) {
    both.draw(frame, what, 0, width, height);
    EXPECT_GT(both.pixels(), 0U) << what;
    both.draw(frame, what, 1, width, height);
  };
  twice("whole", kWidth, kHeight);
  twice("smaller", kWidth / 2 + 1, kHeight / 3);
  twice("whole again", kWidth, kHeight);
  frame.camera = zoomed(frame.camera, 3.0);
  twice("zoomed", kWidth, kHeight);
  frame.stereo = StereoPair{};
  twice("stereo", kWidth - 1, kHeight);
  frame.camera.eye = frame.camera.target + Eigen::Vector3d(0, 0, 0.002);
  twice("within the bone", kWidth, kHeight);
  frame.stereo.reset();
  twice("one eye again", kWidth, kHeight);
}

TEST(BoneLayerScenesTest, ASurfaceThatPacksItsSlotsIsDrawnAsAWhole) {
  RandomStream random(8, "packed");
  const BoneModel model = bumpy(72);
  BoneVolume volume(model);
  Both both(model);
  bone::Surface surface;
  surface.update(volume);
  BoneFrame frame = frame_of(model, volume);
  for (int step = 0; step < 3; ++step) {
    both.draw(frame, "whole", step);
  }
  change(volume, Voxel(36, 36, 30), 31, 1.0F);
  surface.update(volume);
  ASSERT_TRUE(surface.rebuilt());
  for (int step = 0; step < 6; ++step) {
    both.draw(frame, "little is left", step);
    change_at_random(volume, random);
  }
}

TEST(BoneLayerScenesTest, AWindowShowsWhatIsDrawnOffScreen) {
  const BoneModel model = bumpy(30);
  const auto drilled = [&](const auto& draw) {
    std::vector<Image> images;
    BoneVolume volume(model);
    const BoneFrame frame = frame_of(model, volume);
    for (int step = 0; step < 6; ++step) {
      change(volume, Voxel(8 + 3 * step, 15, 26), 3, 1.0F);
      images.push_back(draw(frame));
    }
    return images;
  };
  const std::vector<Image> expected =
      drilled([stage = std::make_unique<Stage>(model, true)](const BoneFrame& frame) {
        return stage->draw(frame);
      });
  const test::VirtualDisplay display(800, 600);
  Window window({"bone", kWidth, kHeight, false, 0, false});
  BoneScene scene(
      window.gl(), Stage::style_of(true), model.structures,
      std::make_shared<bone::StructureDepths>(model, bone::all_but_bone(model.structures)));
  const std::vector<Image> shown = drilled([&](const BoneFrame& frame) {
    scene.draw(frame, kWidth, kHeight);
    Image image = window.read();
    window.swap();
    return image;
  });
  EXPECT_LT(scene.figures().pixels, std::size_t{kWidth * kHeight / 4});
  std::ptrdiff_t most = 0;
  for (std::size_t step = 0; step < shown.size(); ++step) {
    std::ptrdiff_t different = 0;
    for (std::size_t i = 0; i < shown[step].rgb.size(); ++i) {
      different += std::abs(shown[step].rgb[i] - expected[step].rgb[i]) > 2;
    }
    most = std::max(most, different);
  }
  EXPECT_LT(most, kWidth * kHeight * 3 / 500) << "another driver may round another way";
}

TEST(BoneLayerScenesTest, ABoxCoversThePixelsOfAllThatItHolds) {
  RandomStream random(3, "boxes");
  const auto some = [&](double from, double to) {
    return Eigen::Vector3d(random.uniform(from, to), random.uniform(from, to),
                           random.uniform(from, to));
  };
  Camera camera;
  camera.eye = {0.1, 0.05, 0.2};
  const EyeView view = view_of(camera, static_cast<double>(kWidth) / kHeight);
  const Eigen::Matrix4d to_clip = view.projection * view.view;
  int some_pixels = 0;
  for (int n = 0; n < 300; ++n) {
    const Eigen::Vector3d corner = some(-0.1, 0.1);
    const Eigen::AlignedBox3d box(corner, corner + some(0.0, 0.05));
    const PixelBox pixels = pixels_of(box, to_clip, kWidth, kHeight);
    some_pixels += !pixels.isEmpty() && pixels.sizes().prod() < kWidth * kHeight / 4;
    for (int p = 0; p < 30; ++p) {
      const Eigen::Vector4d clip = to_clip * box.sample().homogeneous();
      const Eigen::Vector2d at(0.5 * kWidth * (clip.x() / clip.w() + 1.0),
                               0.5 * kHeight * (clip.y() / clip.w() + 1.0));
      const Eigen::Vector2i pixel = at.array().floor().cast<int>();
      if ((pixel.array() >= 0).all() && pixel.x() < kWidth && pixel.y() < kHeight) {
        EXPECT_TRUE(pixels.contains(pixel));
      }
    }
  }
  EXPECT_GT(some_pixels, 100);
  EXPECT_TRUE(pixels_of({}, to_clip, kWidth, kHeight).isEmpty());
  const Eigen::AlignedBox3d around_the_eye(camera.eye - some(0.01, 0.02),
                                           camera.eye + some(0.01, 0.02));
  EXPECT_EQ(pixels_of(around_the_eye, to_clip, kWidth, kHeight).sizes(),
            Eigen::Vector2i(kWidth - 1, kHeight - 1));
}

}  // namespace
}  // namespace haptrial::render::bone_layer_test
