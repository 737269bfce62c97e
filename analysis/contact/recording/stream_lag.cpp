#include "analysis/contact/recording/stream_lag.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::evaluation {
namespace {

constexpr int kBlocks = 10;
constexpr int kFeatures = 12;  // position, velocity, its direction, acceleration
constexpr double kLeastGain = 0.02;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Takes the mean over `width` samples around each from it.
Rows quick(const Rows& values, Eigen::Index width) {
  Rows sums = Rows::Zero(values.rows() + 1, values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    sums.row(i + 1) = sums.row(i) + values.row(i);
  }
  Rows result(values.rows(), values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const Eigen::Index half = std::min({width / 2, i, values.rows() - 1 - i});
    result.row(i) = values.row(i) - (sums.row(i + half + 1) - sums.row(i - half)) /
                                        static_cast<double>(2 * half + 1);
  }
  return result;
}

/// Quantities that a force may depend on, at even times.
Rows pose_features(const PoseStream& pose, const std::vector<double>& times, double span) {
  const auto n = static_cast<Eigen::Index>(times.size());
  const auto moved = [&](double by) {
    std::vector<double> shifted = times;
    for (double& t : shifted) {
      t += by;
    }
    return resampled(pose, shifted).position;
  };
  const auto at = moved(0.0), before = moved(-span), after = moved(span);
  Rows features(n, kFeatures);
  double speed = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    speed += (after[i] - before[i]).norm() / (2.0 * span) / static_cast<double>(times.size());
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d velocity = (after[k] - before[k]) / (2.0 * span);
    const Eigen::Vector3d acceleration = (after[k] - 2.0 * at[k] + before[k]) / (span * span);
    const double size = std::hypot(velocity.norm(), 0.1 * speed);  // no direction at rest
    features.row(i) << at[k].transpose(), velocity.transpose(),
        (size > 0.0 ? Eigen::Vector3d(velocity / size) : velocity).transpose(),
        acceleration.transpose();
  }
  return features;
}

using Squares = Eigen::Matrix<double, kFeatures, kFeatures>;

/// Sums of one block at one lag.
struct BlockSums {
  Eigen::Matrix<double, kFeatures, 3> xy;
  double yy;
};

double explained_share(const Squares& xx, const BlockSums& s) {
  const auto c = analysis::solve_positive(xx, s.xy);
  return c && s.yy > 0.0 ? (c->array() * s.xy.array()).sum() / s.yy : 0.0;
}

/// The lag of the highest share, between the tried ones by a parabola.
struct Peak {
  double lag, share;
  bool at_end;
};
Peak highest(const std::vector<double>& shares, double first, double step) {
  const auto top = std::max_element(shares.begin(), shares.end());
  const auto i = static_cast<std::size_t>(top - shares.begin());
  if (i == 0 || i + 1 == shares.size()) {
    return {first + static_cast<double>(i) * step, *top, true};
  }
  const double bend = shares[i - 1] - 2.0 * shares[i] + shares[i + 1];
  const double part = bend < 0.0 ? 0.5 * (shares[i - 1] - shares[i + 1]) / bend : 0.0;
  return {first + (static_cast<double>(i) + part) * step, *top, false};
}

class LagSearch {
 public:
  LagSearch(const PoseStream& pose, const ForceStream& force, const LagOptions& options);

  /// @param without  a block to leave out; -1: none
  std::vector<double> shares(int without) const;

 private:
  Squares squares_of_poses(int without) const;

  std::array<Squares, kBlocks> squares_;              // of the poses: the same at every lag
  std::vector<std::array<BlockSums, kBlocks>> sums_;  // by lag
};

LagSearch::LagSearch(const PoseStream& pose, const ForceStream& force, const LagOptions& options) {
  const double first =
      std::max(pose.time.front(), force.time.front()) + options.largest + 2.0 * options.step;
  const double last =
      std::min(pose.time.back(), force.time.back()) - options.largest - 2.0 * options.step;
  const double poses =
      (pose.time.back() - pose.time.front()) / static_cast<double>(pose.size() - 1);
  const double clock = std::max(options.step, 0.5 * poses);  // of the samples that are compared
  const std::vector<double> times = even_times(first, last, clock);
  const auto width = static_cast<Eigen::Index>(options.slowest / clock);
  const Rows x = quick(pose_features(pose, times, poses), width);
  const auto rows_of = [&](const Rows& values, std::size_t block) {
    const auto b = static_cast<Eigen::Index>(block);
    const Eigen::Index begin = x.rows() * b / kBlocks;
    return values.middleRows(begin, x.rows() * (b + 1) / kBlocks - begin);
  };
  for (std::size_t b = 0; b < kBlocks; ++b) {
    squares_[b] = rows_of(x, b).transpose() * rows_of(x, b);
  }
  const auto lags = static_cast<int>(std::round(options.largest / options.step));
  for (int l = -lags; l <= lags; ++l) {
    std::vector<double> shifted = times;
    for (double& t : shifted) {
      t += l * options.step;
    }
    const ForceStream at = resampled(force, shifted, poses);
    Rows y(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      y.row(i) = at.force[static_cast<std::size_t>(i)].transpose();
    }
    y = quick(y, width);
    auto& blocks = sums_.emplace_back();
    for (std::size_t b = 0; b < kBlocks; ++b) {
      blocks[b] = {rows_of(x, b).transpose() * rows_of(y, b), rows_of(y, b).squaredNorm()};
    }
  }
}

Squares LagSearch::squares_of_poses(int without) const {
  Squares sum = Squares::Zero();
  for (int b = 0; b < kBlocks; ++b) {
    if (b != without) {
      sum += squares_[static_cast<std::size_t>(b)];
    }
  }
  for (int i = 0; i < kFeatures; ++i) {
    sum(i, i) += 1e-9 * sum(i, i) + 1e-300;  // features may repeat each other
  }
  return sum;
}

std::vector<double> LagSearch::shares(int without) const {
  const Squares xx = squares_of_poses(without);
  std::vector<double> shares;
  for (const auto& blocks : sums_) {
    BlockSums all{};
    all.xy.setZero();
    all.yy = 0.0;
    for (int b = 0; b < kBlocks; ++b) {
      if (b != without) {
        all.xy += blocks[static_cast<std::size_t>(b)].xy;
        all.yy += blocks[static_cast<std::size_t>(b)].yy;
      }
    }
    shares.push_back(explained_share(xx, all));
  }
  return shares;
}

void check_lag(const PoseStream& pose, const ForceStream& force, const LagOptions& options) {
  check(pose);
  check(force);
  if (!(options.largest > 0.0 && options.step > 0.0 && options.slowest > 0.0 &&
        4.0 * options.step <= options.largest && options.largest < 1e3)) {
    throw std::invalid_argument(
        "largest, step and slowest must be above 0, step at most a quarter "
        "of largest");
  }
  const double overlap = std::min(pose.time.back(), force.time.back()) -
                         std::max(pose.time.front(), force.time.front());
  const double least = std::max(20.0 * options.largest, 5.0 * options.slowest);
  if (!(overlap >= least)) {
    throw std::invalid_argument(
        fmt::format("poses and forces overlap for {:.3g} s; allowed where their lag is to be "
                    "found: {:.3g} s or more; or give it (--lag)",
                    std::max(overlap, 0.0), least));
  }
}

}  // namespace

LagFit estimate_lag(const PoseStream& pose, const ForceStream& force, const LagOptions& options) {
  check_lag(pose, force, options);
  const LagSearch search(pose, force, options);
  const double first = -std::round(options.largest / options.step) * options.step;
  const std::vector<double> shares = search.shares(-1);
  const Peak peak = highest(shares, first, options.step);
  LagFit fit;
  fit.lag = peak.lag;
  fit.explained = peak.share;
  std::array<double, kBlocks> left_out{};
  double mean = 0.0, squares = 0.0;
  for (int b = 0; b < kBlocks; ++b) {
    left_out[static_cast<std::size_t>(b)] = highest(search.shares(b), first, options.step).lag;
    mean += left_out[static_cast<std::size_t>(b)] / kBlocks;
  }
  for (const double lag : left_out) {
    squares += (lag - mean) * (lag - mean);
  }
  const double error = std::sqrt((kBlocks - 1.0) / kBlocks * squares);
  const double half = analysis::t_quantile(0.975, kBlocks - 1.0) * error;
  fit.low = fit.lag - half;
  fit.high = fit.lag + half;
  const double gain = peak.share - *analysis::quantile(shares, 0.5);
  if (peak.at_end) {
    fit.doubt = fmt::format("The best lag is the largest that was tried, {:.3g} s.", fit.lag);
  } else if (gain < kLeastGain) {
    fit.doubt = fmt::format(
        "The lag is not to be trusted: the pose explains {:.1f} % of the force's quick changes at "
        "it and {:.1f} % at the median lag.",
        100.0 * peak.share, 100.0 * (peak.share - gain));
  } else if (2.0 * half > options.largest) {
    fit.doubt = fmt::format("The lag is uncertain: its interval is {:.3g} s wide.", 2.0 * half);
  }
  return fit;
}

}  // namespace haptrial::evaluation
