#include "protocols/psychophysics/definition/measurement.h"

#include <algorithm>
#include <cmath>

namespace haptrial::protocols {

void RunningStatistics::add(double value) noexcept {
  ++count_;
  const double from_mean = value - mean_;
  mean_ += from_mean / static_cast<double>(count_);
  squares_ += from_mean * (value - mean_);
  peak_ = std::abs(value) > std::abs(peak_) || count_ == 1 ? value : peak_;
  end_ = value;
  sum_ += value;
}

/// Chan, Golub and LeVeque 1979: sums of squares of two samples give that of both.
void RunningStatistics::add(const RunningStatistics& more) noexcept {
  if (more.count_ < 2) {
    return more.empty() ? void() : add(more.end_);
  }
  const auto before = static_cast<double>(count_);
  const auto added = static_cast<double>(more.count_);
  const double between = more.mean_ - mean_;
  peak_ = std::abs(more.peak_) > std::abs(peak_) || empty() ? more.peak_ : peak_;
  count_ += more.count_;
  mean_ += between * added / (before + added);
  squares_ += more.squares_ + between * between * before * added / (before + added);
  end_ = more.end_;
  sum_ += more.sum_;
}

double RunningStatistics::value(MeasuredStatistic statistic) const noexcept {
  if (empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return statistic == MeasuredStatistic::kMean   ? mean_
         : statistic == MeasuredStatistic::kPeak ? peak_
         : statistic == MeasuredStatistic::kEnd  ? end_
                                                : std::sqrt(squares_ / static_cast<double>(count_));
}

Measurement::Measurement(const Measure& measure, double rate) : measure_(measure) {
  if (measure.last > 0.0) {
    window_.resize(static_cast<std::size_t>(std::max(1L, std::lround(measure.last * rate))));
  }
}

void Measurement::begin() noexcept {
  all_ = {};
  taken_ = 0;
  newest_ = std::numeric_limits<double>::quiet_NaN();
}

void Measurement::add(double value) noexcept {
  if (!std::isfinite(value)) {
    return;
  }
  RunningStatistics tick;
  tick.add(value);
  add_tick(tick);
}

void Measurement::add_tick(const RunningStatistics& tick) noexcept {
  if (window_.empty()) {
    all_.add(tick);
  } else {
    window_[taken_ % window_.size()] = tick;
  }
  ++taken_;
}

void Measurement::add_samples(std::span<const device::ArrivedValue> arrived, std::size_t place,
                              double newest, double in_stage) noexcept {
  newest_ = newest;
  RunningStatistics tick;
  for (const device::ArrivedValue& sample : arrived) {
    if (sample.place == place && sample.age <= in_stage && std::isfinite(sample.value)) {
      tick.add(sample.value);
    }
  }
  add_tick(tick);
}

void Measurement::add_place(const Eigen::Vector3d& place) noexcept {
  add(taken_ == 0 ? 0.0 : (place - before_).norm());
  before_ = place;
}

double Measurement::value_of(const RunningStatistics& statistics) const noexcept {
  if (statistics.empty() && std::isfinite(newest_)) {
    RunningStatistics newest;
    newest.add(newest_);
    return value_of(newest);
  }
  const double value = measure_.is_summed() && !statistics.empty()
                           ? statistics.sum()
                           : statistics.value(measure_.statistic);
  return measure_.scale * value;
}

double Measurement::value() const noexcept {
  if (window_.empty()) {
    return value_of(all_);
  }
  RunningStatistics last;
  const std::size_t count = std::min(taken_, window_.size());
  for (std::size_t i = taken_ - count; i < taken_; ++i) {
    last.add(window_[i % window_.size()]);
  }
  return value_of(last);
}

}  // namespace haptrial::protocols
