#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/subject/noise.h"
#include "protocols/psychophysics/definition/cursor_parameters.h"

namespace haptrial::protocols {

/// The cursor of one interval.
class Cursor {
 public:
  /// @param rate  of the servo loop > 0 [Hz]; @param seed  of the noise
  Cursor(const CursorParameters& parameters, const ScreenPlane& screen, double rate,
         std::uint64_t seed);

  /// The place of the cursor, a tick later. Servo thread: no allocation, lock, I/O or throw.
  /// @param tool  of the first device, in W [m]
  Eigen::Vector3d follow(const Eigen::Vector3d& tool) noexcept;
  const Eigen::Vector3d& about() const noexcept { return parameters_.about; }

 private:
  Eigen::Vector3d delayed(const Eigen::Vector3d& tool) noexcept;

  CursorParameters parameters_;
  ScreenPlane screen_;
  std::vector<Eigen::Vector3d> past_;  // a ring of the last places of the tool
  std::size_t next_{0};                // of the ring: the oldest
  bool began_{false};
  RandomStream random_;
  std::array<subject::SmoothNoise, 2> noise_;
};

}  // namespace haptrial::protocols
