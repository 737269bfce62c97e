#include "analysis/contact/evaluation/surface_lag.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLagBlocks = 10;
constexpr std::size_t kFewestForces = 100;
constexpr double kStillDoubted = 0.9;  // of what the median lag leaves
constexpr double kRest = 0.1;          // of the mean speed: no direction below it
constexpr std::size_t kReach = 10;     // steps to either side over which lags are compared
constexpr double kAlike = 0.95;        // correlation of lag and friction that is told

/// Sums of one block at one lag over the samples with a force.
struct DirectionSums {
  double count{0.0}, nv{0.0}, vv{0.0}, nf{0.0}, vf{0.0};

  void add(const DirectionSums& o) {
    count += o.count;
    nv += o.nv;
    vv += o.vv;
    nf += o.nf;
    vf += o.vf;
  }
  /// The shares (a, b) of normal and direction that explain unit vectors best.
  Eigen::Vector2d shares() const {
    const double determinant = count * vv - nv * nv;
    if (!(determinant > 1e-12 * count * count)) {
      return {count > 0.0 ? nf / count : 0.0, 0.0};
    }
    return {(vv * nf - nv * vf) / determinant, (count * vf - nv * nf) / determinant};
  }
  /// The mean square that a n + b v leaves of them.
  double left_by(const Eigen::Vector2d& s) const {
    const double explained =
        s[0] * (2.0 * nf - s[0] * count - 2.0 * s[1] * nv) + s[1] * (2.0 * vf - s[1] * vv);
    return count > 0.0 ? 1.0 - explained / count : 1.0;
  }
  double left() const { return left_by(shares()); }
};
using LagBlocks = std::array<DirectionSums, kLagBlocks>;

std::vector<Vector3d> directions(const std::vector<Vector3d>& velocity) {
  double speed = 0.0;
  for (const Vector3d& v : velocity) {
    speed += v.norm() / static_cast<double>(velocity.size());
  }
  std::vector<Vector3d> result;
  for (const Vector3d& v : velocity) {
    const double size = std::hypot(v.norm(), kRest * speed);
    result.emplace_back(size > 0.0 ? Vector3d(v / size) : v);
  }
  return result;
}

LagBlocks sums_at(const SurfaceWay& way, const std::vector<Vector3d>& direction,
                  const ForceStream& force, double lag, double least_force, double width) {
  std::vector<double> times = way.time;
  for (double& t : times) {
    t += lag;
  }
  const ForceStream at = resampled(force, times, width);
  LagBlocks blocks{};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double size = at.force[i].norm();
    if (way.touching[i] && size > least_force) {
      const Vector3d f = at.force[i] / size;
      blocks[i * kLagBlocks / times.size()].add({1.0, way.normal[i].dot(direction[i]),
                                                 direction[i].squaredNorm(), way.normal[i].dot(f),
                                                 direction[i].dot(f)});
    }
  }
  return blocks;
}

DirectionSums sum_of(const LagBlocks& blocks, std::size_t without) {
  DirectionSums all;
  for (std::size_t b = 0; b < kLagBlocks; ++b) {
    all.add(b == without ? DirectionSums{} : blocks[b]);
  }
  return all;
}

/// How the friction that fits best changes with the lag.
struct FrictionByLag {
  double change;  // [1/s]
  bool alike;     // another friction mends most of what another lag spoils
};
FrictionByLag friction_by_lag(const std::vector<LagBlocks>& lags, double at, double step) {
  const auto i = static_cast<std::size_t>(
      std::clamp(std::round(at), 1.0, static_cast<double>(lags.size()) - 2.0));
  const std::size_t reach = std::min({kReach, i, lags.size() - 1 - i});
  const DirectionSums here = sum_of(lags[i], kLagBlocks);
  const DirectionSums before = sum_of(lags[i - reach], kLagBlocks);
  const DirectionSums after = sum_of(lags[i + reach], kLagBlocks);
  const double anew = before.left() + after.left() - 2.0 * here.left();
  const double kept =
      before.left_by(here.shares()) + after.left_by(here.shares()) - 2.0 * here.left();
  const auto friction = [](const DirectionSums& sums) {
    const Eigen::Vector2d shares = sums.shares();
    return shares[0] > 0.0 ? -shares[1] / shares[0] : 0.0;  // 0: nothing presses
  };
  return {(friction(after) - friction(before)) / (2.0 * static_cast<double>(reach) * step),
          kept > 0.0 && anew <= (1.0 - kAlike * kAlike) * kept};
}

/// The lag that leaves least without a block, between the tried ones by a parabola.
struct Valley {
  double lag, left;
  bool at_end;
  double median;
};
Valley lowest(const std::vector<LagBlocks>& lags, std::size_t without, double first, double step) {
  std::vector<double> left;
  for (const LagBlocks& blocks : lags) {
    left.push_back(sum_of(blocks, without).left());
  }
  const auto i =
      static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
  const double median = *analysis::quantile(left, 0.5);
  if (i == 0 || i + 1 == left.size()) {
    return {first + static_cast<double>(i) * step, left[i], true, median};
  }
  const double bend = left[i - 1] - 2.0 * left[i] + left[i + 1];
  const double part = bend > 0.0 ? 0.5 * (left[i - 1] - left[i + 1]) / bend : 0.0;
  return {first + (static_cast<double>(i) + part) * step, left[i], false, median};
}

void check_way(const SurfaceWay& way, const ForceStream& force, double least_force,
               const LagOptions& o) {
  check(force);
  const std::size_t n = way.time.size();
  if (n < kFewestForces || way.normal.size() != n || way.velocity.size() != n ||
      way.touching.size() != n || !(least_force > 0.0)) {
    throw std::invalid_argument(
        "a lag on a surface needs 100 poses or more, equally many normals and velocities, and a "
        "least force above 0");
  }
  if (!(o.largest > 0.0 && o.step > 0.0 && 4.0 * o.step <= o.largest && o.largest < 1e3)) {
    throw std::invalid_argument("largest and step must be above 0, step at most a quarter of it");
  }
}

std::string doubt_of(const Valley& best, double half, const LagOptions& o) {
  if (best.at_end) {
    return fmt::format("The best lag is the largest that was tried, {:.3g} s.", best.lag);
  }
  if (best.left > kStillDoubted * best.median) {
    return "The lag is not to be trusted: the force's direction fits the surface hardly better at "
           "it than at others.";
  }
  return 2.0 * half > o.largest
             ? fmt::format("The lag is uncertain: its interval is {:.3g} s wide.", 2.0 * half)
             : "";
}

}  // namespace

LagFit estimate_surface_lag(const SurfaceWay& way, const ForceStream& force, double least_force,
                            const LagOptions& options) {
  check_way(way, force, least_force, options);
  const std::vector<Vector3d> direction = directions(way.velocity);
  const double width =
      (way.time.back() - way.time.front()) / static_cast<double>(way.time.size() - 1);
  const int lags = static_cast<int>(std::round(options.largest / options.step));
  std::vector<LagBlocks> sums;
  for (int l = -lags; l <= lags; ++l) {
    sums.push_back(sums_at(way, direction, force, l * options.step, least_force, width));
  }
  double forces = 0.0;
  for (const DirectionSums& block : sums[static_cast<std::size_t>(lags)]) {
    forces += block.count;
  }
  if (forces < static_cast<double>(kFewestForces)) {
    throw std::invalid_argument("a lag on a surface needs 100 samples with a force or more");
  }
  const double first = -lags * options.step;
  const Valley best = lowest(sums, kLagBlocks, first, options.step);
  std::array<double, kLagBlocks> left_out{};
  for (std::size_t b = 0; b < kLagBlocks; ++b) {
    left_out[b] = lowest(sums, b, first, options.step).lag;
  }
  // Jackknife: the deviation of the pseudo-values, blocks of neighbours being nearly independent.
  const analysis::Moments m = *analysis::moments(left_out);
  const double blocks = kLagBlocks;
  const double noise =
      analysis::t_quantile(0.975, blocks - 1.0) * std::sqrt((blocks - 1.0) / blocks * m.squares);
  const double half = std::hypot(noise, 0.5 * options.step);  // no finer than the lags tried
  const FrictionByLag friction =
      friction_by_lag(sums, (best.lag - first) / options.step, options.step);
  return {best.lag,
          best.lag - half,
          best.lag + half,
          1.0 - best.left,
          doubt_of(best, half, options),
          friction.change,
          friction.alike};
}

}  // namespace haptrial::evaluation
