#include "analysis/contact/evaluation/stick_phases.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLast = 10;  // samples of a phase that say where it ends
constexpr std::size_t kFewest = 4;

Vector3d along_surface(const Vector3d& v, const Vector3d& normal) {
  return v - v.dot(normal) * normal;
}

/// The parabola through values at 0, 1, …, half a step beyond the last: a hand that starts to move
/// speeds up.
Vector3d extrapolated(const std::vector<Vector3d>& values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1.0), mean_square = (n * n - 1.0) / 12.0;
  Vector3d mean = Vector3d::Zero(), slope = Vector3d::Zero(), bend = Vector3d::Zero();
  double slopes = 0.0, bends = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double u = static_cast<double>(i) - middle, v = u * u - mean_square;
    mean += values[i] / n;
    slope += u * values[i];
    bend += v * values[i];
    slopes += u * u;
    bends += v * v;
  }
  const double end = n - 0.5 - middle;
  return mean + slope / slopes * end + bend / bends * (end * end - mean_square);
}

class PhaseSearch {
 public:
  PhaseSearch(const ContactSamples& samples, const StickOptions& options)
      : s_(samples), o_(options) {}

  bool touches(std::size_t i) const { return s_.force[i].dot(s_.normal[i]) > o_.least_force; }
  double speed(std::size_t i) const { return along_surface(s_.velocity[i], s_.normal[i]).norm(); }
  bool sticks(std::size_t i) const { return touches(i) && speed(i) < o_.slow; }

  /// The sample of fast slip after `last`, the last one that sticks.
  std::optional<std::size_t> slip_after(std::size_t last) const {
    for (std::size_t i = last + 1; i < s_.size() && touches(i) && !sticks(i); ++i) {
      if (speed(i) > o_.fast) {
        return i;
      }
    }
    return std::nullopt;
  }

  double ratio_at_end(std::size_t first, std::size_t last, std::size_t slip) const {
    std::vector<Vector3d> ratios;
    for (std::size_t i = std::max(first, last + 1 - std::min(last + 1, kLast)); i <= last; ++i) {
      const Vector3d& n = s_.normal[i];
      ratios.push_back(-along_surface(s_.force[i], n) / s_.force[i].dot(n));
    }
    const Vector3d ratio = extrapolated(ratios);
    return std::copysign(ratio.norm(), ratio.dot(s_.velocity[slip]));
  }

 private:
  const ContactSamples& s_;
  const StickOptions& o_;
};

}  // namespace

std::vector<double> break_away_ratios(const ContactSamples& samples, const StickOptions& options) {
  const PhaseSearch search(samples, options);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!search.sticks(i)) {
      continue;
    }
    const std::size_t first = i;
    while (i + 1 < samples.size() && search.sticks(i + 1)) {
      ++i;
    }
    const bool long_enough =
        i + 1 - first >= kFewest && samples.time[i] - samples.time[first] >= options.shortest_stick;
    const std::optional<std::size_t> slip = search.slip_after(i);
    if (long_enough && slip) {
      ratios.push_back(search.ratio_at_end(first, i, *slip));
    }
  }
  return ratios;
}

}  // namespace haptrial::evaluation
