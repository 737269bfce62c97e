#include "core/render/bone/tool_shadow.h"

#include <algorithm>

namespace haptrial::render {
namespace {

constexpr double kShadowEnds = 0.04;  // a shadow falls, fading [m]; as in the shader
constexpr double kNearBy = 4.0;       // radii from which on nearness takes nothing; likewise
constexpr double kSoftening = 0.25;   // of the way that it fell: its soft edge, ...
constexpr double kSharpEdge = 1.1;    // ... beyond the radius and 0.1 of it

double distance(const BoneColumn& bone, const Eigen::Vector3d& moved, const Capsule& capsule) {
  return distance_of_segments(bone.nearest + moved, bone.farthest + moved, capsule.from,
                              capsule.to) -
         bone.radius - capsule.radius;
}

/// Whether a capsule may take light of any of the bone: it is near, or on the way to the lamp.
bool darkens(const Capsule& capsule, const BoneColumn& bone) {
  constexpr int kSteps = 8;
  constexpr double kHalf = 0.5 * kShadowEnds / kSteps;
  if (distance(bone, Eigen::Vector3d::Zero(), capsule) < (kNearBy - 1.0) * capsule.radius) {
    return true;
  }
  for (int step = 0; step < kSteps; ++step) {
    const double way = (2 * step + 1) * kHalf;
    const double edge = (kSharpEdge - 1.0) * capsule.radius + kSoftening * (way + kHalf);
    if (distance(bone, way * to_lamp(), capsule) < edge + kHalf) {
      return true;
    }
  }
  return false;
}

}  // namespace

Eigen::Vector3d to_lamp() { return Eigen::Vector3d(0.45, 0.6, 1.0).normalized(); }

double distance_of_segments(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto from_segment = [](const Eigen::Vector3d& p, const Eigen::Vector3d& u,
                               const Eigen::Vector3d& v) {
    const double along = (v - u).squaredNorm();
    const double t = along > 0.0 ? std::clamp((p - u).dot(v - u) / along, 0.0, 1.0) : 0.0;
    return (u + t * (v - u) - p).norm();
  };
  double least = std::min(
      {from_segment(a, c, d), from_segment(b, c, d), from_segment(c, a, b), from_segment(d, a, b)});
  const Eigen::Vector3d across = (b - a).cross(d - c);
  const double square = across.squaredNorm();
  if (square > 0.0) {  // the lines' nearest points, where both lie between the ends
    const double s = (c - a).cross(d - c).dot(across) / square;
    const double t = (c - a).cross(b - a).dot(across) / square;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) {
      least = std::min(least, (a + s * (b - a) - c - t * (d - c)).norm());
    }
  }
  return least;
}

std::vector<PixelTiles::Part> shadowed_parts(const PixelBox& area,
                                             std::span<const Capsule> capsules,
                                             std::span<const BoneColumn> bone) {
  PixelTiles tiles(area);
  for (const BoneColumn& column : bone) {
    unsigned marks = 0;
    for (std::size_t i = 0; i < std::min(capsules.size(), kMostCapsules); ++i) {
      marks |= darkens(capsules[i], column) ? 1U << i : 0U;
    }
    if (marks != 0) {
      tiles.add(column.pixels, static_cast<std::uint8_t>(marks));
    }
  }
  return tiles.parts();
}

}  // namespace haptrial::render
