#include "analysis/device/static_force.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/device/least_squares.h"

namespace haptrial::analysis {
namespace {

using Eigen::VectorXd;

struct HeldForce {
  int axis;
  double level;     // [N]
  double measured;  // along the axis [N]
};

std::vector<HeldForce> held_forces(const CertificateRecord& record, const Excitation& excitation) {
  const PartRecord& part = record.part(CertificatePart::kGrid);
  const long lag = std::lround(record.sensor_age * excitation.rate());
  std::vector<HeldForce> all;
  for (const GridHold& hold : excitation.holds()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    long count = 0;
    for (long t = hold.begin + lag; t < hold.begin + excitation.hold_ticks(); ++t) {
      if (t < static_cast<long>(part.measured.size())) {
        sum += part.measured[static_cast<std::size_t>(t)];
        ++count;
      }
    }
    if (count > 0) {
      const Eigen::Vector3d& d = excitation.directions()[static_cast<std::size_t>(hold.axis)];
      all.push_back({hold.axis, hold.level, d.dot(sum) / static_cast<double>(count)});
    }
  }
  return all;
}

double given(double level, double gain, double dead_zone) {
  const double sign = level > 0.0 ? 1.0 : level < 0.0 ? -1.0 : 0.0;
  return sign * gain * std::max(std::abs(level) - dead_zone, 0.0);
}

Interval not_below_zero(Interval interval) {
  interval.value = std::max(interval.value, 0.0);
  interval.low = std::max(interval.low, 0.0);
  interval.high = std::max(interval.high, 0.0);
  return interval;
}

DirectionForce fit_direction(const std::vector<HeldForce>& holds,
                             const Eigen::Vector3d& direction) {
  const auto residuals = [&](const VectorXd& p, VectorXd& r) {
    for (std::size_t i = 0; i < holds.size(); ++i) {
      const double gain = holds[i].level > 0.0 ? p[0] : p[1];
      r[static_cast<long>(i)] = holds[i].measured - p[3] - given(holds[i].level, gain, p[2]);
    }
  };
  const VectorXd start = (VectorXd(4) << 1.0, 1.0, 0.1, 0.0).finished();
  const VectorXd scale = (VectorXd(4) << 0.1, 0.1, 0.1, 0.1).finished();
  const FittedParameters fit =
      fit_least_squares(start, scale, static_cast<long>(holds.size()), residuals);
  return {direction, fit.interval(0), fit.interval(1), not_below_zero(fit.interval(2))};
}

/// Gain and dead zone that all directions share; each has an offset of its own.
FittedParameters fit_all(const std::vector<HeldForce>& holds, std::size_t axes) {
  const auto residuals = [&](const VectorXd& p, VectorXd& r) {
    for (std::size_t i = 0; i < holds.size(); ++i) {
      r[static_cast<long>(i)] =
          holds[i].measured - p[2 + holds[i].axis] - given(holds[i].level, p[0], p[1]);
    }
  };
  VectorXd start = VectorXd::Zero(static_cast<long>(2 + axes));
  start[0] = 1.0;
  start[1] = 0.1;
  const VectorXd scale = VectorXd::Constant(start.size(), 0.1);
  return fit_least_squares(start, scale, static_cast<long>(holds.size()), residuals);
}

std::vector<LevelForce> errors_of(const std::vector<HeldForce>& holds, std::size_t axes) {
  std::vector<double> offset(axes), count(axes);
  for (const HeldForce& hold : holds) {
    if (hold.level == 0.0) {
      offset[static_cast<std::size_t>(hold.axis)] += hold.measured;
      count[static_cast<std::size_t>(hold.axis)] += 1.0;
    }
  }
  std::map<double, std::vector<double>> by_level;
  for (const HeldForce& hold : holds) {
    const auto axis = static_cast<std::size_t>(hold.axis);
    if (hold.level != 0.0) {
      const double error = hold.measured - offset[axis] / std::max(count[axis], 1.0) - hold.level;
      by_level[std::abs(hold.level)].push_back(std::copysign(1.0, hold.level) * error);
    }
  }
  std::vector<LevelForce> levels;
  for (const auto& [level, errors] : by_level) {
    const auto n = static_cast<double>(errors.size());
    double mean = 0.0, square = 0.0, largest = 0.0;
    for (const double error : errors) {
      mean += error / n;
      largest = std::abs(error) > std::abs(largest) ? error : largest;
    }
    for (const double error : errors) {
      square += (error - mean) * (error - mean);
    }
    levels.push_back({level, interval_of(mean, std::sqrt(square / (n * (n - 1.0))), n - 1.0),
                      std::abs(largest)});
  }
  return levels;
}

}  // namespace

StaticForce identify_static_force(const CertificateRecord& record, const Excitation& excitation) {
  const std::vector<HeldForce> holds = held_forces(record, excitation);
  const std::size_t axes = excitation.directions().size();
  StaticForce found;
  const FittedParameters all = fit_all(holds, axes);
  found.gain = all.interval(0);
  found.dead_zone = not_below_zero(all.interval(1));
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::vector<HeldForce> own;
    std::ranges::copy_if(holds, std::back_inserter(own), [axis](const HeldForce& hold) {
      return static_cast<std::size_t>(hold.axis) == axis;
    });
    found.directions.push_back(fit_direction(own, excitation.directions()[axis]));
  }
  found.levels = errors_of(holds, axes);
  for (const HeldForce& hold : holds) {
    found.commanded.push_back(hold.level);
    found.measured.push_back(hold.measured);
  }
  return found;
}

}  // namespace haptrial::analysis
