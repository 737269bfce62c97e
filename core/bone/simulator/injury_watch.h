#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/soft_tissue.h"

namespace haptrial::bone {

/// The vital structure that was opened last.
struct LastInjury {
  std::uint8_t label{0};                                  // 0: none was opened
  double since{std::numeric_limits<double>::infinity()};  // it last lost a voxel or was torn [s]
};

/// Losses of a structure that follow each other within this time are one injury [s].
inline constexpr double kOneInjury = 1.0;

/// Whether another injury began between two moments.
bool begins(const LastInjury& before, const LastInjury& now) noexcept;

/// Notices at once when a vital structure loses a voxel or a soft one is torn. Servo thread: no
/// allocation, lock or throw.
class InjuryWatch {
 public:
  explicit InjuryWatch(std::span<const Structure> structures) noexcept;
  /// Takes in one tick.
  void tick(std::span<const EmptiedIn> emptied, std::span<const Tear> tears, double dt) noexcept;
  const LastInjury& last() const noexcept { return last_; }

 private:
  std::array<bool, 256> vital_{};
  LastInjury last_;
};

}  // namespace haptrial::bone
