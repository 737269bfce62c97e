#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/simulator/felt_part.h"
#include "core/bone/simulator/simulator_tools.h"

namespace haptrial::bone {

/// The shafts of a session's burrs, as far as they are felt. Servo thread after construction.
class Shafts {
 public:
  /// @param spacing  of the bone's voxels [m]
  Shafts(std::span<const ToolSpec> tools, std::span<const Structure> structures, double spacing,
         const std::array<bool, 256>& soft);

  /// Force on a tool's shaft; zero without a shaft that is felt [N].
  Eigen::Vector3d force(int tool, const BoneWorld& world, const ToolState& state) noexcept;
  /// Leaves the parts unfelt until they are free.
  void wait() noexcept;

 private:
  std::vector<std::unique_ptr<FeltPart>> parts_;  // by tool; null where nothing is felt
};

/// The holder of the burrs: the direction in which it turns them, and the bone that each has
/// removed. Servo thread: no allocation, lock or throw after construction.
class Handpiece {
 public:
  explicit Handpiece(std::span<const ToolSpec> tools);

  /// The other way round from now on.
  void reverse() noexcept { reversed_ = !reversed_; }
  /// Burrs turn against their `rotation`.
  bool reversed() const noexcept { return reversed_; }
  /// The speed of a burr, below 0 against its `rotation`. @param power  0 to 1
  double turning(double power) const noexcept { return reversed_ ? -power : power; }

  /// A burr took bone. @param volume  >= 0 [m^3]
  void take(int tool, double volume) noexcept;
  /// Share of its first removal rate that a tool still has; 1 if it is no burr.
  double sharpness(int tool) const noexcept;

 private:
  struct UsedBurr {
    BurrParameters burr;
    double removed;  // [m^3]
  };
  std::vector<UsedBurr> used_;  // by tool
  bool reversed_{false};
};

}  // namespace haptrial::bone
