#include "analysis/contact/evaluation/contact_samples.h"

#include <cmath>

#include "core/base/require.h"

namespace haptrial::evaluation {
namespace {

constexpr double kUnit = 1e-6;  // a normal's length may be off by this

struct Line {
  Eigen::Vector3d slope;
  double squares;  // what it leaves, over all components
  double spread;   // of the times around their mean, squared and summed
  std::size_t samples;
};

Line fitted_line(std::span<const double> time, std::span<const Eigen::Vector3d> position) {
  double mean = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < time.size(); ++i) {
    mean += time[i] / static_cast<double>(time.size());
    centre += position[i] / static_cast<double>(time.size());
  }
  Line line{Eigen::Vector3d::Zero(), 0.0, 0.0, time.size()};
  for (std::size_t i = 0; i < time.size(); ++i) {
    line.slope += (time[i] - mean) * (position[i] - centre);
    line.spread += (time[i] - mean) * (time[i] - mean);
  }
  line.slope /= line.spread;
  for (std::size_t i = 0; i < time.size(); ++i) {
    line.squares += (position[i] - centre - (time[i] - mean) * line.slope).squaredNorm();
  }
  return line;
}

}  // namespace

void check(const ContactSamples& s) {
  const std::size_t n = s.size();
  require(s.position.size() == n && s.velocity.size() == n && s.normal.size() == n &&
              s.force.size() == n && s.depth.size() == n,
          "samples of a contact must have equally many values of each kind");
  for (std::size_t i = 0; i < n; ++i) {
    require(std::isfinite(s.time[i]) && (i == 0 || s.time[i] > s.time[i - 1]),
            "times of a contact must be finite and increase");
    require(s.position[i].allFinite() && s.velocity[i].allFinite() && s.force[i].allFinite() &&
                std::isfinite(s.depth[i]),
            "samples of a contact must be finite");
    require(std::abs(s.normal[i].norm() - 1.0) < kUnit,
            "normals of a contact must have unit length");
  }
}

PathVelocity path_velocity(std::span<const double> time, std::span<const Eigen::Vector3d> position,
                           double width) {
  require(time.size() >= 3 && time.size() == position.size() && width > 0.0,
          "a path's velocity needs three samples or more and a width above 0");
  PathVelocity result;
  double squares = 0.0, freedom = 0.0, precision = 0.0;
  std::size_t first = 0, end = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    while (time[i] - time[first] > 0.5 * width) {
      ++first;
    }
    while (end < time.size() && time[end] - time[i] <= 0.5 * width) {
      ++end;
    }
    std::size_t from = first, to = end;
    while (to - from < 3) {
      from -= from > 0 ? 1 : 0;
      to += to < time.size() && to - from < 3 ? 1 : 0;
    }
    const Line line = fitted_line(time.subspan(from, to - from), position.subspan(from, to - from));
    result.velocity.push_back(line.slope);
    squares += line.squares;
    freedom += 3.0 * (static_cast<double>(line.samples) - 2.0);
    precision += 1.0 / line.spread / static_cast<double>(time.size());
  }
  result.noise = std::sqrt(squares / freedom * precision);
  return result;
}

}  // namespace haptrial::evaluation
