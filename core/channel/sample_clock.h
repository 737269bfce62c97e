#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace haptrial::channel {

/// Time of a sample on the session's clock.
struct SampleTime {
  std::int64_t time_ns{0};
  double uncertainty{0.0};  // 95 % [s]
  double step{0.0};         // by which its clock has jumped ahead since the last one [s]
};

/// How an instrument's data come in.
struct ClockOptions {
  double latency{0.0};               // from a measurement to its arrival, at least >= 0 [s]
  double latency_uncertainty{1e-3};  // of that, 95 % >= 0 [s]
};

/// Follows the clock of an instrument from the times at which its samples came. A sample is
/// measured at t = offset + rate * d by its own clock d, and comes at r = t + latency + delay with
/// a delay that is never below 0. So offset and rate are those of the highest line below all points
/// (d, r) of the last twenty seconds (Moon, Skelly and Towsley 1999, "Estimation and removal of
/// clock skew"), of which each quarter of a second keeps the lowest. A clock that steps is seen by
/// samples that come before they were measured, or all too late for half a second, during which
/// their uncertainty is how late they are; the line then begins anew.
/// A line below n points with delays of one exponential distribution is late by their least delay,
/// which has the limit (0.05^(-1 / (n - 1)) - 1) times their mean height above it: n (n - 1) times
/// its ratio to the sum of the heights has the F distribution with 2 and 2 n - 2 degrees of
/// freedom.
///
/// One thread; allocates.
class SampleClock {
 public:
  explicit SampleClock(const ClockOptions& options) : options_(options) {}

  /// @param device_time  by the instrument's clock, in ascending order but for steps [s]
  /// @param received_ns  when it came, by the session's clock
  /// @param waited  longest time that it may have lain there; the first samples are known no better
  SampleTime time_of(double device_time, std::int64_t received_ns, double waited = 0.0);
  /// Time of a sample of an instrument without a clock. @param waited  longest time that it may
  /// have lain there before it was read [s]
  SampleTime time_of(std::int64_t received_ns, double waited) const;
  /// Forgets everything: the instrument was opened anew.
  void restart();

 private:
  struct Point {
    double device{0.0};    // [s], since origin_
    double received{0.0};  // [s], since the received time of origin
  };
  void keep(const Point& point);
  void fit();
  double least_step() const;
  bool all_late(double excess, const Point& point);
  double line_at(double device) const { return offset_ + rate_ * device; }

  ClockOptions options_;
  bool has_origin_{false};
  double device_origin_{0.0};
  std::int64_t received_origin_{0};
  std::deque<Point> lowest_;  // of each quarter of a second
  double quarter_{0.0};       // at which the last of them began [s]
  double offset_{0.0};        // of the line [s]
  double rate_{1.0};          // seconds of the session in one of the instrument
  double spread_{0.0};        // of the lowest points above the line [s]
  double least_delay_{0.0};   // of few points, at most (95 %), by which the line is late [s]
  double late_since_{-1.0};   // all samples have been late since then [s]; -1: they are not
  double least_late_{0.0};    // of these, by how much [s]
};

}  // namespace haptrial::channel
