#include "analysis/contact/exam/exam_tools.h"

#include <cmath>
#include <numbers>

#include "analysis/contact/exam/exam_bodies.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::evaluation {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::Mesh;

constexpr double kRise = 0.6;   // of the groove's sides, above the horizontal [rad]
constexpr double kPlay = 2e-4;  // of the peg, to either side [m]

const Vector3d kBox(0.03, 0.02, 0.04);  // [m]
const Vector3d kPeg(0.01, 0.04, 0.01);  // likewise, along y

Isometry3d pose(const Vector3d& at, const Vector3d& turn) {
  Isometry3d pose = Isometry3d::Identity();
  const double angle = turn.norm();
  pose.linear() = angle > 0.0 ? AngleAxisd(angle, turn / angle).toRotationMatrix()
                              : Eigen::Matrix3d::Identity().eval();
  pose.translation() = at;
  return pose;
}

/// Comes down, rocks about both axes, and slides.
Isometry3d on_a_plane(double t) {
  return pose({0.02 * std::sin(5.0 * t), 0.02 - 0.016 * std::sin(3.0 * t), 0.01 * t},
              {0.2 * std::sin(7.0 * t), 0.3 * t, 0.25 * std::sin(11.0 * t)});
}

/// The box goes into the groove with its lower edge, is drawn up the sides, and is turned there.
Isometry3d in_a_groove(double t) {
  return pose({0.012 * std::sin(6.0 * t), 0.03 - 0.02 * std::sin(3.0 * t), 0.01 * t},
              {0.1 * std::sin(9.0 * t), 0.15 * std::sin(5.0 * t), 0.7 + 0.3 * std::sin(4.0 * t)});
}

/// Is turned and pushed against the walls while it goes down.
Isometry3d in_a_shaft(double t) {
  return pose({0.004 * std::sin(8.0 * t), 0.02 * t, 0.003 * std::sin(5.0 * t)},
              {0.15 * std::sin(6.0 * t), 0.1 * std::sin(9.0 * t), 0.2 * std::sin(10.0 * t)});
}

/// A block with a square shaft through it along y.
Mesh block_with_shaft(double half_hole) {
  constexpr double kOut = 0.08, kHigh = 0.12;  // half of its sides [m]
  Mesh mesh;
  for (const double half : {half_hole, kOut}) {
    for (const double y : {-kHigh, kHigh}) {
      for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        mesh.vertices.emplace_back(half * x, y, half * z);
      }
    }
  }
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::int32_t i = 0; i < 4; ++i) {
    const std::int32_t j = (i + 1) % 4;
    quad(i, j, j + 4, i + 4);            // the shaft's wall
    quad(i + 8, i + 12, j + 12, j + 8);  // the block's
    quad(i, i + 8, j + 8, j);            // the lower face
    quad(i + 4, j + 4, j + 12, i + 12);  // the upper one
  }
  return mesh;
}

std::vector<HalfSpace> groove() {
  return {{Vector3d(std::sin(kRise), std::cos(kRise), 0.0), 0.0},
          {Vector3d(-std::sin(kRise), std::cos(kRise), 0.0), 0.0}};
}

std::vector<HalfSpace> shaft(double half) {
  std::vector<HalfSpace> free;
  for (const double side : {-1.0, 1.0}) {
    free.push_back({side * Vector3d::UnitX(), -half});
    free.push_back({side * Vector3d::UnitZ(), -half});
  }
  return free;
}

}  // namespace

const std::vector<ExamTool>& exam_tools() {
  static const double half = 0.5 * kPeg.x() + kPlay;
  static const std::vector<ExamTool> tools{
      {"box on a plane",
       geometry::make_box(kBox),
       mesh_of(TruePlane{}, 1),
       {{Vector3d::UnitY(), 0.0}},
       on_a_plane},
      {"edge in a groove", geometry::make_box(kBox), mesh_of(TrueConcaveEdge{kRise}, 1), groove(),
       in_a_groove},
      {"peg in a shaft", geometry::make_box(kPeg), block_with_shaft(half), shaft(half),
       in_a_shaft}};
  return tools;
}

std::vector<Isometry3d> there_and_back(const ExamTool& tool) {
  constexpr int kTicks = 4000;
  std::vector<Isometry3d> poses;
  for (int i = 0; i <= kTicks; ++i) {
    poses.push_back(tool.hand(0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * i / kTicks))));
  }
  return poses;
}

}  // namespace haptrial::evaluation
