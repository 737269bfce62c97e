#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace haptrial::realtime {

/// Counts durations in fixed bins: one nanosecond wide below 64 ns, then 64 bins to an octave, so
/// that a bin is at most 1/64 of its value wide. The bins reach to the end of std::int64_t.
/// Not thread-safe but for bin() beside one thread that adds.
class DurationHistogram {
 public:
  struct Bin {
    std::int64_t low;   // inclusive [ns]
    std::int64_t high;  // exclusive, but inclusive in the last bin [ns]
    std::uint64_t count;
  };
  static constexpr std::size_t kBins = 64 * 58;

  /// Counts one duration [ns]; below zero counts as zero.
  /// Servo thread: no allocation, lock or throw; constant time.
  void add(std::int64_t duration) noexcept;
  /// Adds the counts of another histogram to this one.

  std::uint64_t count() const noexcept { return count_; }

  /// [ns]; exact; NaN when nothing was counted.
  double min() const noexcept;
  double max() const noexcept;
  double mean() const noexcept;

  /// The smallest bin edge that at least `percent` of the durations do not exceed, and at most
  /// max() [ns]: 99.9 gives the 99.9th percentile. NaN when nothing was counted.
  /// @throws std::invalid_argument unless 0 <= percent <= 100.
  double percentile(double percent) const;

  /// Any thread, also while another adds: of a loop that hangs, say, what it counted is still kept.
  /// @param i  below kBins, or std::out_of_range is thrown.
  Bin bin(std::size_t i) const;

 private:
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t count_{0};
  std::int64_t min_{std::numeric_limits<std::int64_t>::max()};
  std::int64_t max_{0};
  double sum_{0.0};
};

}  // namespace haptrial::realtime
