#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/bone/model/voxel_walk.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/cut_plane.h"
#include "core/bone/simulator/plate.h"
#include "core/bone/simulator/plate_shapes.h"
#include "core/geometry/mesh/procedural.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"

namespace haptrial::bench {

/// The means of every four pixels.
inline render::Image halved(const render::Image& image) {
  render::Image half{image.width / 2, image.height / 2, {}};
  for (int row = 0; row < half.height; ++row) {
    for (int i = 0; i < 3 * half.width; ++i) {
      const auto at = [&](int down, int right) {
        const int column = 2 * (i / 3) + right;
        return static_cast<int>(image.rgb[static_cast<std::size_t>(
            3 * ((2 * row + down) * image.width + column) + i % 3)]);
      };
      half.rgb.push_back(
          static_cast<std::uint8_t>((at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1) + 2) / 4));
    }
  }
  return half;
}

/// Pictures of docs/algorithms/bone-pieces.md.
class PiecesFigures {
 public:
  PiecesFigures(const bone::BoneModel& model, const Eigen::Vector3d& from,
                const Eigen::Vector3d& up)
      : world_(model), context_(2 * kWidth, 2 * kHeight) {
    render::BoneStyle style;
    style.background = {1.0, 1.0, 1.0};
    style.background_visibility = false;
    scene_ = std::make_unique<render::BoneScene>(context_.gl(), style, model.structures, nullptr);
    for (int k = 0; k < model.grid.size[2]; ++k) {
      for (int j = 0; j < model.grid.size[1]; ++j) {
        for (int i = 0; i < model.grid.size[0]; ++i) {
          if (model.labels[model.grid.index(i, j, k)] != 0) {
            box_.extend(model.grid.centre(i, j, k));
          }
        }
      }
    }
    frame_.camera = render::looking_at(box_, from, up, aspect());
  }

  bone::BoneWorld& world() { return world_; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  render::BoneFrame& frame() { return frame_; }

  render::Image draw(bool bones = true) {
    frame_.bones.clear();
    for (int i = 0; bones && i < world_.pieces(); ++i) {
      frame_.bones.push_back({static_cast<std::uint32_t>(i), &world_.volume(i), world_.pose(i)});
    }
    context_.make_current();
    scene_->draw(frame_, 2 * kWidth, 2 * kHeight);
    return halved(context_.read());
  }

  /// Searches until nothing is left to do.
  void settle() {
    for (int quiet = 0; quiet < 4; ++quiet) {
      world_.search();
      for (int tick = 0; tick < 1000; ++tick) {
        world_.step();
        quiet = world_.events().empty() ? quiet : 0;
      }
    }
  }

  /// Moves the second piece, where there is one.
  void move(const Eigen::Isometry3d& by) {
    if (world_.pieces() > 1) {
      world_.grab({1, world_.seeds(1).front(), 0.0}, Eigen::Isometry3d::Identity());
      world_.drag(by);
      world_.release();
    }
  }

  static double aspect() { return double{kWidth} / kHeight; }

  static constexpr int kWidth = 520;
  static constexpr int kHeight = 460;

 private:
  bone::BoneWorld world_;
  render::OffscreenContext context_;
  std::unique_ptr<render::BoneScene> scene_;
  Eigen::AlignedBox3d box_;
  render::BoneFrame frame_;
};

/// Pictures of the same size beside each other.
inline render::Image beside(const std::vector<render::Image>& images) {
  render::Image all;
  all.height = images.front().height;
  for (const render::Image& image : images) {
    all.width += image.width;
  }
  for (int row = 0; row < all.height; ++row) {
    for (const render::Image& image : images) {
      const auto begin = image.rgb.begin() + 3 * row * image.width;
      all.rgb.insert(all.rgb.end(), begin, begin + 3 * image.width);
    }
  }
  return all;
}

/// The plate P's pose on what lies under a rectangle of the bone's side, seen along `inwards`: z
/// outwards along the normal of the plane that fits the bone best, x along the rectangle.
inline Eigen::Isometry3d lying_on(const bone::BoneWorld& world, const Eigen::Vector3d& middle,
                                  const Eigen::Vector3d& inwards, const Eigen::Vector3d& along,
                                  double length, double width) {
  using Eigen::Vector3d;
  std::vector<Vector3d> hits;
  const Vector3d across = inwards.cross(along).normalized();
  for (int i = -6; i <= 6; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vector3d from = middle + i / 12.0 * length * along + j / 4.0 * width * across;
      std::optional<Vector3d> hit;
      for (int piece = 0; piece < world.pieces(); ++piece) {
        const Eigen::Isometry3d pose_BW = world.pose(piece).inverse();
        bone::walk_voxels(world.volume(piece).grid(), pose_BW * from,
                          pose_BW * (from + 0.04 * inwards),
                          [&](const bone::Voxel& voxel, double in, double) {
                            const bool bone = world.volume(piece).density(voxel) > 0.0F;
                            const Vector3d at = from + 0.04 * in * inwards;
                            if (bone && (!hit || (at - from).norm() < (*hit - from).norm())) {
                              hit = at;
                            }
                            return !bone;
                          });
      }
      if (hit) {
        hits.push_back(*hit);
      }
    }
  }
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& hit : hits) {
    mean += hit / static_cast<double>(hits.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& hit : hits) {
    spread += (hit - mean) * (hit - mean).transpose();
  }
  Vector3d z = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  z *= z.dot(inwards) > 0.0 ? -1.0 : 1.0;
  const Vector3d x = (along - along.dot(z) * z).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = mean + 0.004 * z;
  return pose;
}

/// Presses a plate on until so many samples touch bone, and fixes it. @returns its number or -1.
inline int press_on(bone::BoneWorld& world, const bone::PlateModel& plate,
                    Eigen::Isometry3d pose_WP, int touching) {
  for (int step = 0; step < 400; ++step) {
    if (press(plate, pose_WP, world).touching >= touching) {
      return attach(plate, 0, pose_WP, world);
    }
    pose_WP.translation() -= 2e-5 * pose_WP.linear().col(2);
  }
  return -1;
}

/// Figure 10: a plane over a made mandible's right side, the bone cut, the pieces apart.
/// @returns where the cut was.
inline bone::CutPlane draw_cut(PiecesFigures& figures, const std::filesystem::path& folder) {
  using Eigen::Vector3d;
  bone::BoneWorld& world = figures.world();
  const Vector3d size = figures.box().sizes();
  bone::CutPlane plane;
  plane.pose_WC = Eigen::Isometry3d(Eigen::Quaterniond::FromTwoVectors(
      Vector3d::UnitZ(), Vector3d(-0.1, 1.0, 0.25).normalized()));
  plane.pose_WC.translation() =
      figures.box().min() + Vector3d(0.13 * size.x(), 0.52 * size.y(), 0.25 * size.z());
  plane.width = 0.034;
  plane.height = 0.045;
  plane.depth = 0.001;
  std::vector<render::Image> images;
  figures.frame().camera = render::zoomed(figures.frame().camera, 0.88);
  figures.frame().meshes = {
      {std::make_shared<geometry::Mesh>(render::plane_mesh(plane.width, plane.height)),
       plane.pose_WC,
       {0.2, 0.45, 0.85, 0.45}}};
  images.push_back(figures.draw());
  bone::CutPlaneTool tool;
  for (tool.begin(world, plane); tool.busy();) {
    tool.step(world);
  }
  figures.frame().meshes.clear();
  images.push_back(figures.draw());
  figures.settle();
  Eigen::Isometry3d apart(Eigen::AngleAxisd(0.12, Vector3d::UnitX()));
  apart.translation() = Vector3d(-0.008, 0.012, 0.004);
  figures.move(apart);
  images.push_back(figures.draw());
  figures.move(apart.inverse());
  render::write_png(folder / "bone-pieces.png", beside(images));
  return plane;
}

/// Figure 11: a plate with its samples; over a gap of 4 mm; and a distractor in the same place.
inline void draw_plates(PiecesFigures& figures, const bone::CutPlane& cut,
                        const std::filesystem::path& folder) {
  using Eigen::Isometry3d;
  using Eigen::Vector3d;
  bone::BoneWorld& world = figures.world();
  std::vector<render::Image> images;
  const bone::PlateModel plate("plate", make_plate(bone::straight_miniplate(4)));
  const render::Colour metal{0.62, 0.66, 0.72};
  const Camera overview = figures.frame().camera;
  figures.frame().meshes = {
      {std::make_shared<geometry::Mesh>(plate.mesh()), Isometry3d::Identity(), metal}};
  const auto ball = std::make_shared<geometry::Mesh>(geometry::make_sphere(0.18e-3, 4));
  for (const bone::PlateSample& sample : plate.samples()) {
    figures.frame().meshes.push_back(
        {ball, Isometry3d(Eigen::Translation3d(sample.point)), {0.85, 0.2, 0.15}});
  }
  figures.frame().camera =
      render::looking_at(geometry::bounds(plate.mesh()), Vector3d(0.3, -1.0, 1.3),
                         Vector3d::UnitZ(), figures.aspect());
  images.push_back(figures.draw(false));

  const Vector3d normal = cut.pose_WC.linear().col(2);
  figures.move(Isometry3d(Eigen::Translation3d(0.004 * normal)));
  const Vector3d middle = cut.pose_WC.translation() + 0.0025 * normal + Vector3d(-0.02, 0, -0.004);
  const Vector3d along = Vector3d(-0.05, 1.0, 0.1).normalized();
  const bone::PlateModel distractor("distractor", bone::make_distractor(5e-3));
  figures.frame().camera = render::zoomed(overview, 2.3);
  figures.frame().camera.target = cut.pose_WC.translation() + Vector3d(0, 0, 0.004);
  for (const bone::PlateModel* model : {&plate, &distractor}) {
    const bool straight = model == &plate;
    const Isometry3d over =
        lying_on(world, middle, Vector3d::UnitX(), along, straight ? 0.02 : 0.012, 0.012);
    const int number = press_on(world, *model, over, 12);
    figures.frame().meshes.clear();
    if (number >= 0) {
      figures.frame().meshes = {
          {std::make_shared<geometry::Mesh>(model->mesh()), world.plate_pose(number), metal}};
    }
    images.push_back(figures.draw());
    world.detach_plate(number);
  }
  render::write_png(folder / "bone-plates.png", beside(images));
}

inline void draw_pieces(const bone::BoneModel& model, const std::filesystem::path& folder) {
  PiecesFigures figures(model, {-1.0, -0.5, 0.35}, Eigen::Vector3d::UnitZ());
  const bone::CutPlane cut = draw_cut(figures, folder);
  draw_plates(figures, cut, folder);
}

}  // namespace haptrial::bench
