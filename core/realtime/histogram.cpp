#include "core/realtime/histogram.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace haptrial::realtime {
namespace {

constexpr int kSubBits = 6;  // 64 bins to an octave
constexpr std::size_t kSubBins = std::size_t{1} << kSubBits;

// Octave 0 holds 0 .. 63 one by one; octave k > 0 starts at 64 * 2^(k - 1).
std::size_t bin_of(std::uint64_t duration) noexcept {
  if (duration < kSubBins) {
    return duration;
  }
  const int shift = static_cast<int>(std::bit_width(duration)) - 1 - kSubBits;
  return (static_cast<std::size_t>(shift) << kSubBits) + (duration >> shift);
}

std::int64_t low_of(std::size_t bin) noexcept {
  if (bin < 2 * kSubBins) {
    return static_cast<std::int64_t>(bin);
  }
  const std::size_t shift = (bin >> kSubBits) - 1;
  return static_cast<std::int64_t>((kSubBins + bin % kSubBins) << shift);
}

/// One thread writes a count; any may read it meanwhile.
void count_one_more(std::uint64_t& count) noexcept {
  std::atomic_ref(count).store(count + 1, std::memory_order_relaxed);
}

std::uint64_t read_beside(const std::uint64_t& count) noexcept {
  return std::atomic_ref(const_cast<std::uint64_t&>(count)).load(std::memory_order_relaxed);
}

}  // namespace

void DurationHistogram::add(std::int64_t duration) noexcept {
  duration = std::max<std::int64_t>(duration, 0);
  count_one_more(counts_[bin_of(static_cast<std::uint64_t>(duration))]);
  ++count_;
  min_ = std::min(min_, duration);
  max_ = std::max(max_, duration);
  sum_ += static_cast<double>(duration);
}

double DurationHistogram::min() const noexcept {
  return count_ == 0 ? std::nan("") : static_cast<double>(min_);
}

double DurationHistogram::max() const noexcept {
  return count_ == 0 ? std::nan("") : static_cast<double>(max_);
}

double DurationHistogram::mean() const noexcept {
  return count_ == 0 ? std::nan("") : sum_ / static_cast<double>(count_);
}

double DurationHistogram::percentile(double percent) const {
  if (!(percent >= 0.0 && percent <= 100.0)) {
    throw std::invalid_argument("DurationHistogram: a percentile lies between 0 and 100");
  }
  if (count_ == 0) {
    return std::nan("");
  }
  const double rank = std::max(1.0, std::ceil(percent / 100.0 * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    seen += counts_[i];
    if (static_cast<double>(seen) >= rank) {
      return std::min(static_cast<double>(bin(i).high - 1), max());
    }
  }
  return max();
}

DurationHistogram::Bin DurationHistogram::bin(std::size_t i) const {
  if (i >= kBins) {
    throw std::out_of_range("DurationHistogram::bin: there is no such bin");
  }
  const std::int64_t high =
      i + 1 == kBins ? std::numeric_limits<std::int64_t>::max() : low_of(i + 1);
  return {low_of(i), high, read_beside(counts_[i])};
}

}  // namespace haptrial::realtime
