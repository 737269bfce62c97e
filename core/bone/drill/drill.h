#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/bone/drill/burr.h"
#include "core/bone/drill/drill_kernel.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Immersion of a burr in a bone, summed over its samples. Vectors are in the frame in which the
/// burr's pose was given; those of several bones add up in one frame.
struct Contact {
  std::int32_t samples{0};                            // that lie in bone
  double volume{0.0};                                 // theirs [m^3]
  Eigen::Vector3d push{Eigen::Vector3d::Zero()};      // sum of directions to the centre [m^3]
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};      // sum of (p - sc) x d [m^4]
  Eigen::Vector3d centroid{Eigen::Vector3d::Zero()};  // of the immersed samples [m]; 0 without
  std::int32_t first{0};                              // of its samples in the drill's list
  std::int32_t kept{0};                               // of them in that list
  std::int32_t first_cell{0};  // of the burr's cells that lie in bone whole, in the drill's list
  std::int32_t cells{0};       // of them
  kernel::Placement at{};      // of the burr in the bone

  explicit operator bool() const noexcept { return samples > 0; }
};

/// The same contact seen from W. Its place in the drill's list stays.
/// @param X_WB  pose of the bone B in W
Contact in_world(const Contact& contact_B, const Eigen::Isometry3d& X_WB) noexcept;
/// Sum of both contacts: sums of sums, centroid by volume; for feeling only (nothing in the list).
Contact together(const Contact& a, const Contact& b) noexcept;

/// A voxel that has just lost its last bone.
struct EmptiedVoxel {
  std::int32_t address;  // in its volume
  std::uint8_t label;
};

/// Bone that one tick removed from one bone.
struct Removal {
  double amount{0.0};  // sum of the densities taken; times the volume of a voxel is volume
  double volume{0.0};  // [m^3]
  std::span<const EmptiedVoxel> emptied;  // until the next remove()
};

/// A burr at work in bones. One tick is
///
///     drill.begin_tick();
///     contact = drill.touch(volume, tip, orientation);       // for each bone near the burr
///     force = bone_force(contact, ...);                      // core/bone/drill/feel.h
///     removal = drill.remove(volume, contact, force.norm(), power, dt);
///
/// Servo thread: nothing here allocates, locks, waits or throws after construction
/// (DrillTest.TickDoesNotAllocate). The same bits on every instruction set.
class Drill {
 public:
  /// Samples that lie in bone are remembered for remove() until the list is full: so many times
  /// the burr's samples, which only bones that overlap one another can reach. What does not fit is
  /// felt but not drilled.
  static constexpr std::int32_t kBonesAtOnce = 4;
  /// The most samples of a burr in cells that remove bone in one tick. Where more lie in bone they
  /// take turns, each for the ticks it has missed: what is removed in the mean stays.
  static constexpr std::int32_t kMostTaking = 20'000;

  /// @param structures  by label: how hard they are; labels beyond are as hard as bone
  /// @param soft  by label: what the burr neither feels nor removes here (simulator/soft_tissue.h)
  /// @throws std::invalid_argument when a hardness is not above 0 or the machine lacks `set`.
  Drill(const BurrParameters& burr, std::span<const Structure> structures,
        InstructionSet set = best_instruction_set(), const std::array<bool, 256>& soft = {});

  const Burr& burr() const noexcept { return burr_; }
  /// Burr::set_rates().
  void set_rates(double removal_rate, double falloff) noexcept {
    burr_.set_rates(removal_rate, falloff);
  }
  /// Voxels that remove() empties in a tick at most.
  std::size_t most_emptied() const noexcept { return emptied_.size(); }

  /// Forgets the contacts of the last tick.
  void begin_tick() noexcept {
    kept_ = 0;
    cells_kept_ = 0;
    emptied_used_ = 0;
    ++ticks_;
  }

  /// The burr's samples that lie in bone.
  /// @param tip_B           the burr's centre in the bone's frame [m]
  /// @param orientation_B   from the tool frame to the bone's
  /// @returns nothing in contact where a number is not finite, the orientation has no length, or
  /// the burr is wider than 10,000 voxels.
  Contact touch(const BoneVolume& volume, const Eigen::Vector3d& tip_B,
                const Eigen::Quaterniond& orientation_B) noexcept;

  /// Takes bone away at the contact's samples, each
  ///
  ///     force · sample power · power · dt · (sample volume / voxel volume) / hardness
  ///
  /// of its voxel's density, in multiples of 2^-23: sums are exact where densities are multiples
  /// of that too. Source: Morris 2006, §3.2.3.6.
  /// @param contact  of this volume, from this tick
  /// @param force    that the user applies [N]; nothing is removed unless it, dt and power are
  ///                 finite and above 0
  /// @param power    how fast the burr turns, from 0 to 1
  /// @param dt       since the last tick [s]
  Removal remove(BoneVolume& volume, const Contact& contact, double force, double power,
                 double dt) noexcept;

 private:
  std::int32_t touch_cells(const BoneVolume::View& view, const kernel::Placement& at,
                           kernel::Sums& sums) noexcept;
  class Taking;
  void take_cells(Taking& taking, const Contact& contact, std::uint64_t turns) noexcept;
  void leave_soft(const BoneVolume& volume, Contact& contact, kernel::Sums& sums) noexcept;

  Burr burr_;
  kernel::TouchBurr touch_;
  kernel::FindBurr find_;
  std::array<bool, 256> soft_;
  bool any_soft_;
  std::array<float, 256> softness_;  // 1 / hardness, by label
  std::int32_t kept_{0};
  std::vector<kernel::Hit> hits_;  // kept_ of them in use
  std::int32_t cells_kept_{0};
  std::vector<std::int32_t> cells_;  // that lie in bone whole; cells_kept_ of them in use
  std::vector<EmptiedVoxel> emptied_;
  std::size_t emptied_used_{0};
  std::uint64_t ticks_{0};
};

}  // namespace haptrial::bone
