#include "core/bone/simulator/screws.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::bone {
namespace {

using Eigen::Vector3d;

constexpr double kAtHole = 2e-3;     // of the driver's tip to a hole [m]
constexpr double kStraight = 0.94;   // least cosine between driver and hole: 20 degrees
constexpr double kLookEvery = 5e-5;  // between looks at the bone, at most [m]
constexpr int kLooks = 6;            // looks on the circle of the thread

/// Bone on the circle of a thread.
struct OnThread {
  double density{0.0};  // mean, from 0 to 1
  int piece{-1};        // that holds some of it
};

OnThread look(const BoneWorld& world, const Eigen::Isometry3d& hole, double radius,
              double depth) noexcept {
  OnThread found;
  for (int n = 0; n < kLooks; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kLooks;
    const Vector3d at = hole * Vector3d(radius * std::cos(angle), radius * std::sin(angle), -depth);
    for (int piece = 0; piece < world.pieces(); ++piece) {
      const BoneVolume& volume = world.volume(piece);
      const Vector3d p_B = world.pose(piece).inverse(Eigen::Isometry) * at;
      const Eigen::Array3d place =
          (p_B - volume.grid().origin).array() / volume.grid().spacing + 0.5;
      const float density =
          place.abs().maxCoeff() < 1e6 ? volume.density(Voxel(place.floor().cast<int>())) : 0.0F;
      if (density > 0.0F) {
        found.density += static_cast<double>(density) / kLooks;
        found.piece = world.known_as(piece);
        break;
      }
    }
  }
  return found;
}

}  // namespace

Screws::Hole Screws::hole_at(const BoneWorld& world,
                             std::span<const std::unique_ptr<PlateModel>> models,
                             const ToolState& state) const noexcept {
  Hole nearest;
  double least = kAtHole;
  for (int plate = 0; plate < world.plates(); ++plate) {
    const Eigen::Isometry3d& pose = world.plate_pose(plate);
    const std::vector<Eigen::Isometry3d>& holes = models[at(world.plate_model(plate))]->holes();
    for (std::size_t hole = 0; world.plate_is_on(plate) && hole < holes.size(); ++hole) {
      const Eigen::Isometry3d at_hole = pose * holes[hole];
      const double distance = (at_hole.translation() - state.tip.position).norm();
      if (distance < least && at_hole.linear().col(2).dot(state.axis()) >= kStraight) {
        least = distance;
        nearest = {plate, static_cast<int>(hole), at_hole};
      }
    }
  }
  return nearest;
}

/// @returns its number; -1 where there is no room for another one
int Screws::screw_in(const Hole& hole, int tool) noexcept {
  const int known = count();
  for (int number = 0; number < known; ++number) {
    if (place(number).plate == hole.plate && place(number).hole == hole.hole) {
      return number;
    }
  }
  if (known == kMaxScrews) {
    return -1;
  }
  screws_[at(known)] = {{hole.plate, hole.hole, tool}, -1, 0.0, 0.0, 0.0};
  count_.store(known + 1, std::memory_order_release);
  return known;
}

void Screws::drive(const BoneWorld& world, std::span<const std::unique_ptr<PlateModel>> models,
                   const ScrewTool& tool, int number, const ToolState& state, double power,
                   double dt) noexcept {
  const Hole hole = power > 0.0 ? hole_at(world, models, state) : Hole{};
  const int now = hole.plate >= 0 ? screw_in(hole, number) : -1;
  if (now != driven_) {
    rest();
  }
  if (now < 0 || screw(now).depth >= tool.length) {
    rest();
    return;
  }
  driven_ = now;
  Screw& screw = screws_[at(now)];
  const double end = std::min(tool.length, screw.depth + tool.pitch * tool.turns * power * dt);
  while (screw.depth < end) {
    const double step = std::min(kLookEvery, end - screw.depth);
    const OnThread bone = look(world, hole.pose, 0.5 * tool.diameter, screw.depth + 0.5 * step);
    screw.purchase += step * bone.density;
    screw.piece = bone.piece >= 0 ? bone.piece : screw.piece;
    screw.depth = end - screw.depth > kLookEvery ? screw.depth + step : end;
  }
  screw.torque = tool.torque_rate * screw.purchase;
  if (screw.depth >= tool.length) {
    rest();
  }
}

void Screws::take_out(int plate) noexcept {
  for (int number = 0; number < count(); ++number) {
    if (place(number).plate == plate) {
      Screw& screw = screws_[at(number)];  // its place may be read meanwhile
      screw.piece = -1;
      screw.depth = screw.purchase = screw.torque = 0.0;
      driven_ = driven_ == number ? -1 : driven_;
    }
  }
}

void Screws::rest() noexcept {
  ended_ = driven_ >= 0 ? driven_ : ended_;
  driven_ = -1;
}

}  // namespace haptrial::bone
