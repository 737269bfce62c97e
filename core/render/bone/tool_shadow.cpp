#include "core/render/bone/tool_shadow.h"

#include <algorithm>

#include "core/render/bone/bone_layer.h"

namespace haptrial::render {
namespace {

constexpr double kFarthest = 0.04;  // a shadow falls, fading [m]; as in the shader
constexpr double kNearBy = 4.0;     // radii from which on nearness takes nothing; likewise
constexpr double kSoftest = 0.01;   // its soft edge at the farthest: 0.25 of the way [m], ...
constexpr double kEdge = 1.1;       // ... and 0.1 of the radius, beyond the radius

/// Whether a capsule may take light of anything in a ball: it is near, or on the way to the lamp.
/// @param lamp  the way to the lamp as far as shadows fall [m]
bool darkens(const Capsule& capsule, const BoneBall& ball, const Eigen::Vector3d& lamp) {
  const double from_ball =
      distance_of_segments(ball.centre, ball.centre, capsule.from, capsule.to) - ball.radius;
  if (from_ball < kNearBy * capsule.radius) {
    return true;
  }
  const double from_light =
      distance_of_segments(ball.centre, ball.centre + lamp, capsule.from, capsule.to) - ball.radius;
  return from_light < kEdge * capsule.radius + kSoftest;
}

PixelBox pixels_of_ball(const BoneBall& ball, const EyeView& view, const PixelBox& area) {
  const Eigen::Vector3d centre = (view.view * ball.centre.homogeneous()).head<3>();
  const Eigen::AlignedBox3d around(Eigen::Vector3d(centre.array() - ball.radius),
                                   Eigen::Vector3d(centre.array() + ball.radius));
  return pixels_of(around, view.projection, area.sizes().x() + 1, area.sizes().y() + 1);
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

std::vector<PixelTiles::Part> shadowed_parts(const EyeView& view, const PixelBox& area,
                                             std::span<const Capsule> capsules,
                                             std::span<const BoneBall> bones) {
  const Eigen::Vector3d lamp =
      kFarthest * (view.view.topLeftCorner<3, 3>().transpose() * to_lamp());
  PixelTiles tiles(area);
  for (const BoneBall& ball : bones) {
    unsigned marks = 0;
    for (std::size_t i = 0; i < std::min(capsules.size(), kMostCapsules); ++i) {
      marks |= darkens(capsules[i], ball, lamp) ? 1U << i : 0U;
    }
    if (marks != 0) {
      tiles.add(pixels_of_ball(ball, view, area), static_cast<std::uint8_t>(marks));
    }
  }
  return tiles.parts();
}

}  // namespace haptrial::render
