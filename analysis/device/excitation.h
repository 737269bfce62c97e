#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/point_state.h"

namespace haptrial::analysis {

/// The parts of a certificate's measurement, in their order.
enum class CertificatePart : std::uint8_t {
  kRest,       // handle clamped, no force is commanded
  kGrid,       // clamped, forces in all directions are held
  kFrequency,  // clamped, a force of many frequencies along each axis
  kMove,       // the handle is moved along each axis, no force is commanded
  kFree,       // the handle is let go, forces move it along each axis
  kLoaded,     // likewise, with a known mass on the handle
  kWall,       // the handle is pressed against walls that grow stiffer
  kDone,
};

/// The axes of a part of a handle along which it gives forces, 0 to 2 for x to z.
using DrivenAxes = std::vector<int>;

/// A hold of the grid: a force, and the ticks over which its effect is averaged.
struct GridHold {
  int axis;      // of directions()
  double level;  // along it, either sign [N]
  long begin;    // first tick of the average, from the beginning of the part
};

/// Commands of a certificate's measurement, the same for whoever gives them and whoever evaluates
/// them. A rotation or a grip has its places and forces at the fingers, as a tip has
/// (core/device/handle_part.h). Built before the loop; command() is for the servo thread.
class Excitation {
 public:
  static constexpr long kHoldTicks = 70;  // of a hold's average, at 1 kHz

  /// @param rate       of the servo loop, 500 to 20000 [Hz]
  /// @param max_force  that is commanded > 0 [N]
  /// @param axes       that are driven, at least one
  /// @param reach      of a free movement to either side, about > 0 [m]
  Excitation(double rate, double max_force, DrivenAxes axes = {0, 1, 2}, double reach = 0.1);

  double rate() const noexcept { return rate_; }
  double max_force() const noexcept { return max_force_; }
  const DrivenAxes& axes() const noexcept { return axes_; }
  long ticks(CertificatePart part) const noexcept;
  /// @param tick  from the beginning of the part.  @returns the force to command [N].
  Eigen::Vector3d command(CertificatePart part, long tick) const noexcept;
  /// The force that keeps a handle that was let go near the origin, along the axis that moves;
  /// added to the command of kFree and kLoaded [N]. It comes and goes by centred().
  Eigen::Vector3d centring(CertificatePart part, long tick, const PointState& tool) const noexcept;
  /// How much of the centring and the excitation acts in kFree or kLoaded, from 0 to 1: it grows
  /// and falls within half a second at the ends of each axis' time.
  double centred(CertificatePart part, long tick) const noexcept;
  /// The axis along which kFree or kLoaded moves the handle on this tick, 0 to 2.
  int moved_axis(CertificatePart part, long tick) const noexcept;
  /// Where a machine that holds the handle takes it; the origin unless the part is kMove [m].
  /// @param reach  to either side [m]
  Eigen::Vector3d position(CertificatePart part, long tick, double reach) const noexcept;

  /// Unit vectors, thirteen with three axes; with their opposites, 26 directions.
  const std::vector<Eigen::Vector3d>& directions() const noexcept { return directions_; }
  const std::vector<GridHold>& holds() const noexcept { return holds_; }
  long hold_ticks() const noexcept { return scaled(kHoldTicks); }
  /// Frequencies of kFrequency, whole multiples of 1 Hz, which is its period [Hz].
  const std::vector<int>& frequencies() const noexcept { return frequencies_; }
  static constexpr int kPeriods = 6;  // after one that lets transients die away
  long period_ticks() const noexcept { return period_; }
  /// Ticks of kMove, and of kFree, along one axis.
  long axis_ticks(CertificatePart part) const noexcept { return ticks(part) / count_of_axes(); }

 private:
  long scaled(long at_1_khz) const noexcept;
  long count_of_axes() const noexcept { return static_cast<long>(axes_.size()); }
  /// The unit vector along which a part is excited on a tick. @param per_axis  ticks of each axis
  Eigen::Vector3d axis_at(long tick, long per_axis) const noexcept;
  double free_force() const noexcept;

  double rate_;
  double max_force_;
  DrivenAxes axes_;
  double reach_;
  long period_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> grid_levels_;  // a level for each hold of an axis [N]
  std::vector<GridHold> holds_;
  std::vector<int> frequencies_;
  std::vector<double> wave_;  // a period of the sum of sines, at most 1 in size
};

}  // namespace haptrial::analysis
