#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/device/device.h"
#include "protocols/psychophysics/definition/measure.h"

namespace haptrial::protocols {

/// Mean, deviation, greatest size, last value and sum of numbers as they come. All functions: no
/// allocation, lock, I/O or throw.
class RunningStatistics {
 public:
  void add(double value) noexcept;
  void add(const RunningStatistics& more) noexcept;
  /// NaN without a number. @param statistic  of those that are not summed
  double value(MeasuredStatistic statistic) const noexcept;
  double sum() const noexcept { return sum_; }
  bool empty() const noexcept { return count_ == 0; }

 private:
  std::size_t count_{0};
  double mean_{0.0}, squares_{0.0}, peak_{0.0}, end_{0.0}, sum_{0.0};
};

/// A measure while its stage goes on. Servo thread after construction: no allocation, lock, I/O or
/// throw (MeasurementTest.DoesNotAllocate).
class Measurement {
 public:
  /// @param rate  of the servo loop > 0 [Hz]
  Measurement(const Measure& measure, double rate);

  const Measure& measure() const noexcept { return measure_; }
  /// Its stage begins with this tick.
  void begin() noexcept;
  /// Takes the quantity of a tick, in SI; one that is not finite is left out.
  void add(double value) noexcept;
  /// Takes what a channel gave on a tick: each sample of `place` that was measured in the stage.
  /// Samples that come after its end count for no stage. While none has come, the newest value
  /// stands for the stage, though it may have been measured before. @param in_stage  time of the
  /// tick in it [s]
  void add_samples(std::span<const device::ArrivedValue> arrived, std::size_t place, double newest,
                   double in_stage) noexcept;
  /// Takes the place of a tick, from which the way since the tick before follows [m].
  void add_place(const Eigen::Vector3d& place) noexcept;
  /// The number of the ticks so far, in Measure::unit; NaN if there are none.
  double value() const noexcept;

 private:
  double value_of(const RunningStatistics& statistics) const noexcept;
  void add_tick(const RunningStatistics& tick) noexcept;

  Measure measure_;
  RunningStatistics all_;
  std::vector<RunningStatistics> window_;  // ring of the last ticks; empty: all ticks count
  std::size_t taken_{0};                   // ticks of the stage
  double newest_{std::numeric_limits<double>::quiet_NaN()};  // of a channel, on the last tick
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::protocols
