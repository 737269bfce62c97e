#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "analysis/reaching/reach.h"

namespace haptrial::test {

/// A recording that owns its samples.
struct Recorded {
  std::vector<double> time;
  std::vector<Eigen::Vector3d> position, velocity, force;
  Eigen::Vector3d start{0.0, 0.0, 0.0}, target{0.0, 0.0, -0.1};
  double go{0.2};

  analysis::Reach reach() const { return {time, position, velocity, force, start, target, go}; }
};

/// Minimum-jerk share of the way and its rate, at a share of the time (Flash and Hogan 1985).
inline double minimum_jerk(double s) {
  const double c = std::clamp(s, 0.0, 1.0);
  return c * c * c * (10.0 + c * (-15.0 + 6.0 * c));
}
inline double minimum_jerk_rate(double s) {
  const double c = std::clamp(s, 0.0, 1.0);
  return 30.0 * c * c * (1.0 - c) * (1.0 - c);
}

/// A path over its share 0 .. 1, taken with the time course of minimum jerk from `begin` on.
/// @param slope  d path / d share.
inline Recorded along_path(const std::function<Eigen::Vector3d(double)>& path,
                           const std::function<Eigen::Vector3d(double)>& slope, double begin,
                           double duration, double rest = 0.4, double rate = 1000.0) {
  Recorded recorded;
  const int samples = static_cast<int>((begin + duration + rest) * rate);
  for (int i = 0; i <= samples; ++i) {
    const double t = i / rate;
    const double s = (t - begin) / duration;
    recorded.time.push_back(t);
    recorded.position.push_back(path(minimum_jerk(s)));
    recorded.velocity.push_back(slope(minimum_jerk(s)) * minimum_jerk_rate(s) / duration);
  }
  recorded.start = path(0.0);
  recorded.target = path(1.0);
  return recorded;
}

inline Recorded straight(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double begin = 0.5,
                         double duration = 0.5) {
  return along_path([=](double s) -> Eigen::Vector3d { return from + s * (to - from); },
                    [=](double) -> Eigen::Vector3d { return to - from; }, begin, duration);
}

/// An arc of a circle from (0, 0, 0) to (0, 0, -chord) that bulges to the left (-x) and spans
/// `angle` [rad].
inline Recorded arc(double chord, double angle, double begin = 0.5, double duration = 0.5) {
  const double radius = 0.5 * chord / std::sin(0.5 * angle);
  const double deep = radius * std::cos(0.5 * angle);
  const auto at = [=](double s) -> Eigen::Vector3d {
    const double a = angle * (s - 0.5);
    return {deep - radius * std::cos(a), 0.0, -0.5 * chord - radius * std::sin(a)};
  };
  const auto slope = [=](double s) -> Eigen::Vector3d {
    const double a = angle * (s - 0.5);
    return {angle * radius * std::sin(a), 0.0, -angle * radius * std::cos(a)};
  };
  return along_path(at, slope, begin, duration);
}

inline Recorded transformed(Recorded recorded, const Eigen::Matrix3d& matrix) {
  for (auto* values : {&recorded.position, &recorded.velocity, &recorded.force}) {
    for (Eigen::Vector3d& v : *values) {
      v = (matrix * v).eval();
    }
  }
  recorded.start = (matrix * recorded.start).eval();
  recorded.target = (matrix * recorded.target).eval();
  return recorded;
}

}  // namespace haptrial::test
