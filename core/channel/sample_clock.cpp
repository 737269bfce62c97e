#include "core/channel/sample_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace haptrial::channel {
namespace {

constexpr double kQuarter = 0.25;         // of which one point is kept [s]
constexpr std::size_t kQuarters = 80;     // 20 s
constexpr std::size_t kForRate = 12;      // points from which on the rate is estimated
constexpr double kMostDrift = 0.01;       // of the rate, from 1
constexpr double kUnknownDrift = 200e-6;  // before the rate is estimated
constexpr double kLateFor = 0.5;          // until what is late is a step [s]
constexpr double kLeastStep = 5e-3;       // [s]
constexpr double kFirstStep = 0.1;        // of the second point of a line [s]
constexpr double kCovered = 0.95;         // by the uncertainty

}  // namespace

void SampleClock::restart() {
  has_origin_ = false;
  lowest_.clear();
  offset_ = 0.0;
  rate_ = 1.0;
  spread_ = 0.0;
  least_delay_ = 0.0;
  late_since_ = -1.0;
}

SampleTime SampleClock::time_of(std::int64_t received_ns, double waited) const {
  const double delay = options_.latency + 0.5 * waited;
  return {received_ns - std::llround(1e9 * delay),
          std::hypot(options_.latency_uncertainty, 0.5 * waited), 0.0};
}

/// The least step of the clock, above any delay of a sample: a first point alone may be late by
/// any.
double SampleClock::least_step() const {
  return lowest_.size() == 1 ? kFirstStep : std::max({kLeastStep, 4.0 * spread_, least_delay_});
}

/// Whether samples have been late for so long, without one that was not, that the clock stepped.
bool SampleClock::all_late(double excess, const Point& point) {
  if (excess < least_step()) {
    late_since_ = -1.0;
    return false;
  }
  if (late_since_ < 0.0 || point.received < late_since_) {
    late_since_ = point.received;
    least_late_ = excess;
  }
  least_late_ = std::min(least_late_, excess);
  return point.received - late_since_ >= kLateFor;
}

SampleTime SampleClock::time_of(double device_time, std::int64_t received_ns, double waited) {
  double step = 0.0;
  if (!has_origin_) {
    has_origin_ = true;
    device_origin_ = device_time;
    received_origin_ = received_ns;
  }
  Point point{device_time - device_origin_,
              1e-9 * static_cast<double>(received_ns - received_origin_)};
  if (!lowest_.empty()) {
    const double excess = point.received - line_at(point.device);
    const bool backwards = excess < -least_step();
    if (backwards || all_late(excess, point)) {
      step = -(backwards ? excess : least_late_);
      restart();
      has_origin_ = true;
      device_origin_ = device_time;
      received_origin_ = received_ns;
      point = {};
    }
  }
  keep(point);
  const double span = point.device - lowest_.front().device;
  const double drift = lowest_.size() < kForRate
                           ? kUnknownDrift * span
                           : 2.0 * spread_ * kQuarter / std::max(span, kQuarter);
  const double arrived = point.received;
  const double measured = std::min(line_at(point.device), arrived) - options_.latency;
  SampleTime time;
  time.time_ns = received_origin_ + std::llround(1e9 * measured);
  time.uncertainty =
      std::hypot(options_.latency_uncertainty, std::max(spread_, least_delay_) + drift);
  if (lowest_.size() == 1) {  // the line may be as late as its only point
    time.uncertainty = std::max(time.uncertainty, waited);
  }
  if (late_since_ >= 0.0) {  // a delay, or a step that is not known yet
    time.uncertainty = std::max(time.uncertainty, point.received - line_at(point.device));
  }
  time.step = step;
  return time;
}

/// Keeps the point if it is the lowest of its quarter, and fits the line anew with each quarter.
void SampleClock::keep(const Point& point) {
  const auto height = [this](const Point& p) { return p.received - rate_ * p.device; };
  if (lowest_.empty() || point.device >= quarter_ + kQuarter) {
    quarter_ = point.device;
    lowest_.push_back(point);
    if (lowest_.size() > kQuarters) {
      lowest_.pop_front();
    }
    fit();
  } else if (height(point) < height(lowest_.back())) {
    lowest_.back() = point;
    if (height(point) < offset_) {
      fit();
    }
  }
}

/// The edge of the lower convex hull that lies above the middle of the points is the highest line
/// below all of them.
void SampleClock::fit() {
  if (lowest_.size() < kForRate) {
    rate_ = 1.0;
    offset_ = std::numeric_limits<double>::infinity();
    for (const Point& p : lowest_) {
      offset_ = std::min(offset_, p.received - p.device);
    }
  } else {
    std::vector<Point> hull;
    double middle = 0.0;
    for (const Point& p : lowest_) {
      middle += p.device / static_cast<double>(lowest_.size());
      while (hull.size() >= 2) {
        const Point& a = hull[hull.size() - 2];
        const Point& b = hull.back();
        const double turn = (b.device - a.device) * (p.received - a.received) -
                            (b.received - a.received) * (p.device - a.device);
        if (turn > 0.0) {
          break;
        }
        hull.pop_back();
      }
      hull.push_back(p);
    }
    std::size_t edge = 0;
    while (edge + 2 < hull.size() && hull[edge + 1].device < middle) {
      ++edge;
    }
    const Point& a = hull[edge];
    const Point& b = hull[edge + 1];
    rate_ = std::clamp((b.received - a.received) / (b.device - a.device), 1.0 - kMostDrift,
                       1.0 + kMostDrift);
    offset_ = a.received - rate_ * a.device;
  }
  std::vector<double> above;
  for (const Point& p : lowest_) {
    above.push_back(p.received - line_at(p.device));
  }
  const auto middle = above.begin() + static_cast<std::ptrdiff_t>(above.size() / 2);
  std::nth_element(above.begin(), middle, above.end());
  spread_ = std::max(0.0, *middle);
  least_delay_ = 0.0;
  if (const auto n = static_cast<double>(above.size()); n > 1.0 && above.size() < kForRate) {
    const double mean = std::accumulate(above.begin(), above.end(), 0.0) / n;
    least_delay_ = mean * (std::pow(1.0 - kCovered, -1.0 / (n - 1.0)) - 1.0);
  }
}

}  // namespace haptrial::channel
