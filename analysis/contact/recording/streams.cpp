#include "analysis/contact/recording/streams.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::evaluation {
namespace {

void require_stream(bool good, const std::string& sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}

void check_times(std::span<const double> times, const std::string& name) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    require_stream(
        std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1]),
        name + " must be finite and increase; sample " + std::to_string(i) + " does not");
  }
}

void check_finite(const std::vector<Eigen::Vector3d>& values, const std::string& name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    require_stream(values[i].allFinite(),
                   name + " must be finite; sample " + std::to_string(i) + " is not");
  }
}

/// The sample at or before t and the share of the way to the next one.
struct Between {
  std::size_t sample;
  double share;
};
Between between(const std::vector<double>& time, double t) {
  if (t <= time.front()) {
    return {0, 0.0};
  }
  if (t >= time.back()) {
    return {time.size() - 2, 1.0};
  }
  const auto next = std::upper_bound(time.begin(), time.end(), t);
  const auto at = static_cast<std::size_t>(next - time.begin()) - 1;
  return {at, (t - time[at]) / (time[at + 1] - time[at])};
}

/// A broken line through samples and its integral from the first one.
class BrokenLine {
 public:
  BrokenLine(const std::vector<double>& time, const std::vector<Eigen::Vector3d>& values)
      : time_(time), values_(values), sum_(time.size(), Eigen::Vector3d::Zero()) {
    for (std::size_t i = 1; i < time.size(); ++i) {
      sum_[i] = sum_[i - 1] + 0.5 * (time[i] - time[i - 1]) * (values[i] + values[i - 1]);
    }
  }

  Eigen::Vector3d value(double t) const {
    const auto [at, share] = between(time_, t);
    return (1.0 - share) * values_[at] + share * values_[at + 1];
  }
  Eigen::Vector3d mean(double t, double width) const {
    return width > 0.0
               ? Eigen::Vector3d((integral(t + 0.5 * width) - integral(t - 0.5 * width)) / width)
               : value(t);
  }

 private:
  Eigen::Vector3d integral(double t) const {
    if (t < time_.front()) {
      return (t - time_.front()) * values_.front();
    }
    if (t > time_.back()) {
      return sum_.back() + (t - time_.back()) * values_.back();
    }
    const std::size_t at = between(time_, t).sample;
    return sum_[at] + 0.5 * (t - time_[at]) * (values_[at] + value(t));
  }

  const std::vector<double>& time_;
  const std::vector<Eigen::Vector3d>& values_;
  std::vector<Eigen::Vector3d> sum_;
};

/// The usual time between changes; 0 where there are none. @param changes  rows, the first is one
double usual_hold(const std::vector<double>& time, const std::vector<std::size_t>& changes) {
  std::vector<double> holds;
  for (std::size_t c = 1; c < changes.size(); ++c) {
    holds.push_back(time[changes[c]] - time[changes[c - 1]]);
  }
  if (holds.empty()) {
    return 0.0;
  }
  const auto middle = holds.begin() + static_cast<std::ptrdiff_t>(holds.size() / 2);
  std::nth_element(holds.begin(), middle, holds.end());
  return *middle;
}

/// The rows at which a stream changed, and where it stayed the same, the end of that: a line drawn
/// from its beginning to the next change would leave the value that was held.
/// @param repeats  whether a row says the same as the one before it
template <class Repeats>
std::vector<std::size_t> rows_of_changes(const std::vector<double>& time, const Repeats& repeats) {
  constexpr double kLong = 3.0;    // usual holds from which on a value was read again and again
  constexpr double kBefore = 0.5;  // usual holds before the next change
  std::vector<std::size_t> changes;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (i == 0 || !repeats(i)) {
      changes.push_back(i);
    }
  }
  const double usual = usual_hold(time, changes);
  std::vector<std::size_t> rows;
  for (std::size_t c = 0; c < changes.size(); ++c) {
    rows.push_back(changes[c]);
    const bool at_end = c + 1 == changes.size();
    std::size_t last = (at_end ? time.size() : changes[c + 1]) - 1;
    const double until = at_end ? time[last] : time[changes[c + 1]] - kBefore * usual;
    while (time[last] > until && last > changes[c]) {
      --last;
    }
    if (usual > 0.0 && time[last] - time[changes[c]] > kLong * usual) {
      rows.push_back(last);
    }
  }
  return rows;
}

}  // namespace

void check(const PoseStream& pose) {
  require_stream(pose.size() >= 2, "a pose stream needs two samples or more");
  require_stream(pose.position.size() == pose.size() && pose.orientation.size() == pose.size(),
                 "times, positions and orientations must be equally many");
  check_times(pose.time, "times of poses");
  check_finite(pose.position, "positions");
  for (std::size_t i = 0; i < pose.size(); ++i) {
    require_stream(std::abs(pose.orientation[i].norm() - 1.0) < 1e-6,
                   "orientations must have unit length; sample " + std::to_string(i) + " has not");
  }
}

void check(const ForceStream& force) {
  require_stream(force.size() >= 2, "a force stream needs two samples or more");
  require_stream(force.force.size() == force.size(), "times and forces must be equally many");
  require_stream(force.torque.empty() || force.torque.size() == force.size(),
                 "torques must be as many as times, or none");
  check_times(force.time, "times of forces");
  check_finite(force.force, "forces");
  check_finite(force.torque, "torques");
}

PoseStream changes(const PoseStream& pose) {
  PoseStream result;
  const auto repeats = [&](std::size_t i) {
    return pose.position[i] == pose.position[i - 1] &&
           pose.orientation[i].coeffs() == pose.orientation[i - 1].coeffs();
  };
  for (const std::size_t row : rows_of_changes(pose.time, repeats)) {
    result.time.push_back(pose.time[row]);
    result.position.push_back(pose.position[row]);
    result.orientation.push_back(pose.orientation[row]);
  }
  return result;
}

ForceStream changes(const ForceStream& force) {
  ForceStream result;
  const bool torque = !force.torque.empty();
  const auto repeats = [&](std::size_t i) {
    return force.force[i] == force.force[i - 1] &&
           (!torque || force.torque[i] == force.torque[i - 1]);
  };
  for (const std::size_t row : rows_of_changes(force.time, repeats)) {
    result.time.push_back(force.time[row]);
    result.force.push_back(force.force[row]);
    if (torque) {
      result.torque.push_back(force.torque[row]);
    }
  }
  return result;
}

PoseStream resampled(const PoseStream& pose, std::span<const double> times) {
  check(pose);
  check_times(times, "times to resample at");
  PoseStream result;
  for (const double t : times) {
    const auto [at, share] = between(pose.time, t);
    result.time.push_back(t);
    result.position.emplace_back((1.0 - share) * pose.position[at] + share * pose.position[at + 1]);
    result.orientation.push_back(
        pose.orientation[at].slerp(share, pose.orientation[at + 1]).normalized());
  }
  return result;
}

ForceStream resampled(const ForceStream& force, std::span<const double> times, double width) {
  check(force);
  check_times(times, "times to resample at");
  require_stream(width >= 0.0 && std::isfinite(width), "width must be finite and not negative");
  ForceStream result;
  result.time.assign(times.begin(), times.end());
  const auto fill = [&](const std::vector<Eigen::Vector3d>& from,
                        std::vector<Eigen::Vector3d>& to) {
    const BrokenLine line(force.time, from);
    for (const double t : times) {
      to.push_back(line.mean(t, width));
    }
  };
  fill(force.force, result.force);
  if (!force.torque.empty()) {
    fill(force.torque, result.torque);
  }
  return result;
}

std::vector<double> even_times(double first, double last, double step) {
  require_stream(step > 0.0 && first <= last && (last - first) / step < 1e9,
                 "times need a step above 0, first <= last and fewer than 1e9 steps");
  std::vector<double> times;
  const auto count = static_cast<std::size_t>((last - first) / step + 1e-9) + 1;
  times.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(first + static_cast<double>(i) * step);
  }
  return times;
}

}  // namespace haptrial::evaluation
