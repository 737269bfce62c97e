#include "analysis/psychometric/fit/adaptive_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/psychometric/fit/prior.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kAxes = 4;  // threshold, log width, lapse, guess
constexpr std::array<std::size_t, kAxes> kFirstCells{48, 36, 3, 3};
constexpr std::array<std::size_t, kAxes> kCells{56, 44, 4, 4};
constexpr double kLeftOut = 1e-5;      // of a cell of the first grid
constexpr double kLeastShare = 1e-15;  // share of answers; no level is impossible

/// Equal cells between two ends; one cell where these are the same.
struct CellAxis {
  double low{0.0}, high{0.0};
  std::size_t count{1};

  double step() const { return (high - low) / static_cast<double>(count); }
  double middle(std::size_t i) const { return low + (static_cast<double>(i) + 0.5) * step(); }
};
using CellAxes = std::array<CellAxis, kAxes>;

CellAxis axis_of(double low, double high, std::size_t count) {
  return {low, high, high > low ? count : 1};
}

double quantile_at(const CellAxis& axis, const std::vector<double>& shares, double share) {
  double below = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (below + shares[i] >= share && shares[i] > 0.0) {
      return axis.low + axis.step() * (static_cast<double>(i) + (share - below) / shares[i]);
    }
    below += shares[i];
  }
  return axis.high;
}

CredibleInterval central(const CellAxis& axis, const std::vector<double>& shares, double level) {
  return {quantile_at(axis, shares, 0.5 * (1.0 - level)),
          quantile_at(axis, shares, 0.5 * (1.0 + level))};
}

struct AdaptivePrior {
  StimulusRange range;
  double scale;  // a width of these tails over one with tails of 0.05

  double smallest() const { return scale * range.spacing; }
  double largest() const { return scale * (range.high - range.low); }

  /// Logarithm of the density of the lapse rate: Beta(1, 10), as psignifit's.
  static double log_of_lapse(double lapse) { return 9.0 * std::log1p(-lapse); }

  static CredibleInterval of_lapse(const CellAxis& axis, double level) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < axis.count; ++i) {
      shares.push_back(std::exp(log_of_lapse(axis.middle(i))));
    }
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) {
      share /= sum;
    }
    return central(axis, shares, level);
  }

  /// Density of the logarithm of the width.
  double of_log_width(double log_width) const {
    constexpr double kUniformBelow = 0.1;
    const double w = std::exp(log_width), d = smallest(), s = largest();
    const double rise = 1.0 - cosine_fall((w - d) / d);
    const double drop = w < 2.0 * d ? 1.0 : cosine_fall((w - s) / (2.0 * s));
    return rise * drop * w / (w + kUniformBelow * s);
  }
};

class AdaptiveGrid {
 public:
  AdaptiveGrid(std::span<const TrialBlock> blocks, const LikelihoodOptions& options)
      : blocks_(blocks),
        x_(coordinates(options.function.axis, blocks)),
        curve_(psychometric::curve_of(options.function)),
        task_(options.task),
        guess_(options.function.guess),
        prior_{range_of(options, x_),
               psychometric::rate_of_width(options.function.sigmoid, 1.0, options.function.tail) /
                   psychometric::rate_of_width(options.function.sigmoid, 1.0)},
        lapse_(options.lapse),
        free_guess_(options.guess) {}

  /// Posterior probabilities of the cells; guess rates run fastest.
  std::vector<double> masses(const CellAxes& axes) const {
    std::vector<double> cells;
    cells.reserve(axes[0].count * axes[1].count * axes[2].count * axes[3].count);
    Shares shares(blocks_.size());
    for (std::size_t t = 0; t < axes[0].count; ++t) {
      for (std::size_t w = 0; w < axes[1].count; ++w) {
        add(axes, axes[0].middle(t), axes[1].middle(w), shares, cells);
      }
    }
    const double most = *std::max_element(cells.begin(), cells.end());
    double sum = 0.0;
    for (double& cell : cells) {
      cell = std::exp(cell - most);
      sum += cell;
    }
    for (double& cell : cells) {
      cell /= sum;
    }
    return cells;
  }

  /// All that the prior allows.
  CellAxes first_axes() const {
    const double half = 0.5 * (prior_.range.high - prior_.range.low);
    const bool yes_no = task_ == Task::kYesNo;
    return {axis_of(prior_.range.low - half, prior_.range.high + half, kFirstCells[0]),
            axis_of(std::log(prior_.smallest()), std::log(3.0 * prior_.largest()), kFirstCells[1]),
            axis_of(lapse_.low, lapse_.high, kFirstCells[2]),
            yes_no ? axis_of(free_guess_.low, free_guess_.high, kFirstCells[3]) : CellAxis{}};
  }

  CredibleInterval guess_interval(const CredibleInterval& lapse, const CellAxis& axis,
                                  const std::vector<double>& shares, double level) const {
    return task_ == Task::kForcedChoice ? CredibleInterval{guess_, guess_}
           : task_ == Task::kYesNo      ? central(axis, shares, level)
                                        : lapse;
  }

  FittedParameters parameters(const CellAxes& axes, std::size_t cell) const {
    const std::size_t g = cell % axes[3].count, l = cell / axes[3].count % axes[2].count;
    const std::size_t w = cell / (axes[3].count * axes[2].count) % axes[1].count;
    const std::size_t t = cell / (axes[3].count * axes[2].count * axes[1].count);
    const double lapse = axes[2].middle(l);
    return {axes[0].middle(t), std::exp(axes[1].middle(w)), lapse,
            guess_of(lapse, axes[3].middle(g)), 0.0};
  }

 private:
  struct Shares {
    explicit Shares(std::size_t blocks) : within(blocks), beyond(blocks) {}
    std::vector<double> within, beyond;  // S and 1 - S of each block
  };

  double guess_of(double lapse, double free) const {
    return task_ == Task::kForcedChoice ? guess_ : task_ == Task::kYesNo ? free : lapse;
  }

  void add(const CellAxes& axes, double threshold, double log_width, Shares& shares,
           std::vector<double>& cells) const {
    const double prior = std::log(std::max(prior_.of_log_width(log_width), 1e-300));
    const double width = std::exp(log_width);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const psychometric::SigmoidPoint s = curve_.at(x_[i], threshold, width);
      shares.within[i] = s.share;
      shares.beyond[i] = s.beyond;
    }
    for (std::size_t l = 0; l < axes[2].count; ++l) {
      for (std::size_t g = 0; g < axes[3].count; ++g) {
        const double lapse = axes[2].middle(l);
        cells.push_back(prior + AdaptivePrior::log_of_lapse(lapse) +
                        log_likelihood(shares, lapse, guess_of(lapse, axes[3].middle(g))));
      }
    }
  }

  double log_likelihood(const Shares& shares, double lapse, double guess) const {
    const double between = 1.0 - guess - lapse;
    double sum = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const int right = blocks_[i].correct, wrong = blocks_[i].total - right;
      if (right > 0) {
        sum += right * std::log(std::max(guess + between * shares.within[i], kLeastShare));
      }
      if (wrong > 0) {
        sum += wrong * std::log(std::max(lapse + between * shares.beyond[i], kLeastShare));
      }
    }
    return sum;
  }

  std::span<const TrialBlock> blocks_;
  std::vector<double> x_;
  psychometric::SigmoidCurve curve_;
  Task task_;
  double guess_;
  AdaptivePrior prior_;
  RateBounds lapse_, free_guess_;
};

/// Probabilities of the cells of one axis.
std::vector<double> marginal_of(const std::vector<double>& cells, const CellAxes& axes,
                                std::size_t axis) {
  std::size_t inner = 1;
  for (std::size_t a = axis + 1; a < kAxes; ++a) {
    inner *= axes[a].count;
  }
  std::vector<double> shares(axes[axis].count, 0.0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    shares[i / inner % shares.size()] += cells[i];
  }
  return shares;
}

/// Ends that leave out what has hardly any probability.
CellAxis narrowed(const CellAxis& axis, const std::vector<double>& shares, std::size_t count) {
  std::size_t first = 0, last = shares.size() - 1;
  while (first < last && shares[first] < kLeftOut) {
    ++first;
  }
  while (last > first && shares[last] < kLeftOut) {
    --last;
  }
  const double low = axis.low + axis.step() * static_cast<double>(first > 0 ? first - 1 : 0);
  const double high =
      axis.low + axis.step() * static_cast<double>(std::min(last + 2, shares.size()));
  return axis_of(low, high, count);
}

}  // namespace

AdaptivePosterior adaptive_posterior(std::span<const TrialBlock> blocks,
                                     const LikelihoodOptions& options, double level,
                                     std::size_t draws) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  const LikelihoodFitter checks_blocks_and_options(options, blocks);
  const std::vector<TrialBlock> levels = pooled(blocks);
  const AdaptiveGrid grid(levels, options);
  CellAxes axes = grid.first_axes();
  const std::vector<double> first = grid.masses(axes);
  const CellAxes all = axes;
  for (std::size_t a = 0; a < 2; ++a) {
    axes[a] = narrowed(all[a], marginal_of(first, all, a), kCells[a]);
  }
  for (std::size_t a = 2; a < kAxes; ++a) {
    axes[a].count = axes[a].count > 1 ? kCells[a] : 1;
  }
  const std::vector<double> cells = grid.masses(axes);
  AdaptivePosterior result;
  result.threshold = central(axes[0], marginal_of(cells, axes, 0), level);
  const CredibleInterval log_width = central(axes[1], marginal_of(cells, axes, 1), level);
  result.width = {std::exp(log_width.low), std::exp(log_width.high)};
  const std::vector<double> thresholds = marginal_of(cells, axes, 0);
  const double most = *std::max_element(thresholds.begin(), thresholds.end());
  result.low_end = axes[0].low > all[0].low ? 0.0 : thresholds.front() / most;
  result.high_end = axes[0].high < all[0].high ? 0.0 : thresholds.back() / most;
  const auto median = [&](std::size_t a) {
    return quantile_at(axes[a], marginal_of(cells, axes, a), 0.5);
  };
  result.median = {median(0), std::exp(median(1)), median(2), 0.0, 0.0};
  result.median.guess = options.task == Task::kYesNo          ? median(3)
                        : options.task == Task::kForcedChoice ? options.function.guess
                                                              : result.median.lapse;
  result.lapse = central(axes[2], marginal_of(cells, axes, 2), level);
  const CredibleInterval prior = AdaptivePrior::of_lapse(axes[2], level);
  result.lapse_told = !(result.lapse.high - result.lapse.low > 0.8 * (prior.high - prior.low));
  result.guess = grid.guess_interval(result.lapse, axes[3], marginal_of(cells, axes, 3), level);
  // Systematic: one of each 1 / draws of the probability.
  double below = 0.0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    below += cells[cell];
    while (result.draws.size() < draws &&
           (static_cast<double>(result.draws.size()) + 0.5) / static_cast<double>(draws) < below) {
      result.draws.push_back(grid.parameters(axes, cell));
    }
  }
  return result;
}

}  // namespace haptrial::analysis
