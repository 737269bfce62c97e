#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/dust/dust_surroundings.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Structures that bleed where they are opened.
struct BleedingParameters {
  std::vector<std::string> structures;  // as the bone calls them, or by any of their names
  double rate{1e-7};                    // of each opening > 0 [m3/s]
};

/// The keys of [bleeding].
const Schema<BleedingParameters>& bleeding_schema();

/// @throws InputError for a structure that is neither the bone's nor known by its name
void check_bleeding(const BoneModel& model, const BleedingParameters& parameters);

/// A place that began to bleed.
struct Opening {
  std::uint8_t label{0};
  Eigen::Vector3d place_B{Eigen::Vector3d::Zero()};  // [m]
};

/// Blood of opened vessels: where the first voxel of one goes, or it is torn, is an opening, which
/// bleeds evenly from then on; what is opened nearer than kApart to another one is part of that.
/// The blood itself is a Dust without a slope of repose. Servo thread: no allocation, lock or throw
/// after construction.
class Bleeding {
 public:
  static constexpr std::size_t kMost = 32;       // openings; further ones do not bleed
  static constexpr double kApart = 5e-3;         // of two openings of one vessel [m]
  static constexpr std::uint64_t kBetween = 16;  // ticks from one deposit of an opening to the next

  /// @throws InputError as check_bleeding()
  Bleeding(const BoneModel& model, const BleedingParameters& parameters);

  bool empty() const noexcept { return !any_; }
  bool bleeds(std::uint8_t label) const noexcept { return bleeds_[label]; }
  /// Forgets what began and flowed on the last tick.
  void begin_tick() noexcept;
  /// A vessel is open at a place.
  void open(std::uint8_t label, const Eigen::Vector3d& place_B) noexcept;
  /// Lets it bleed. @param pose_WB  of the bone
  void tick(const Eigen::Isometry3d& pose_WB, double dt) noexcept;

  /// Openings that began on this tick.
  std::span<const Opening> begun() const noexcept { return std::span(openings_).subspan(before_); }
  std::size_t openings() const noexcept { return openings_.size(); }
  /// Blood that flowed on this tick.
  std::span<const DustDeposit> deposits() const noexcept { return deposits_; }

 private:
  double rate_;     // of an opening [voxels/s]
  double spacing_;  // of voxels [m]
  bool any_;
  std::array<bool, 256> bleeds_{};
  std::vector<Opening> openings_;  // room for kMost
  std::vector<double> owed_;       // (openings) that has not been deposited [voxels]
  std::vector<DustDeposit> deposits_;
  std::size_t before_{0};  // openings, at the beginning of the tick
  std::uint64_t ticks_{0};
};

}  // namespace haptrial::bone
