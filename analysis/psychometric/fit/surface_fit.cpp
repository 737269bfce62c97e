#include "analysis/psychometric/fit/surface_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace haptrial::analysis {
namespace {

/// A parameter between the values that a definition lists. A place counts in knots: 1.5 is halfway
/// from the second to the third of the values in rising order.
class Knots {
 public:
  explicit Knots(const psychometric::QuestDimension& parameter);

  double last() const noexcept { return static_cast<double>(values_.size() - 1); }
  /// @param place  0 to last()
  double value(double place) const noexcept { return between(values_, place); }
  /// The prior's weight there, for equal steps of the place.
  double weight(double place) const noexcept { return between(weights_, place); }

 private:
  static double between(const std::vector<double>& of, double place) noexcept;

  std::vector<double> values_;   // rising
  std::vector<double> weights_;  // likewise
};

Knots::Knots(const psychometric::QuestDimension& parameter) {
  std::vector<std::pair<double, double>> knots;
  for (std::size_t i = 0; i < parameter.values.size(); ++i) {
    knots.emplace_back(parameter.values[i], parameter.prior.empty() ? 1.0 : parameter.prior[i]);
  }
  std::sort(knots.begin(), knots.end());
  for (const auto& [value, weight] : knots) {
    values_.push_back(value);
    weights_.push_back(weight);
  }
}

double Knots::between(const std::vector<double>& of, double place) noexcept {
  if (of.size() == 1) {
    return of.front();
  }
  const auto left = std::min(static_cast<std::size_t>(std::max(0.0, place)), of.size() - 2);
  const double share = place - static_cast<double>(left);
  return of[left] + share * (of[left + 1] - of[left]);
}

using psychometric::QuestDefinition;

constexpr std::size_t kSearchCells = 3000;   // of a grid that looks for the posterior
constexpr std::size_t kFinalCells = 20'000;  // of the one that gives the results
constexpr std::size_t kMostSteps = 401;      // of one parameter
constexpr double kNothing = 1e-3;  // of the largest marginal: 3.7 standard deviations away
constexpr double kSettled = 0.8;   // a box that shrinks by less has found the posterior
constexpr int kMostGrids = 12;
constexpr std::size_t kDraws = 400;
constexpr double kOutsideInterval = 0.025;  // of the posterior, on each side of an interval
constexpr double kEdge = 0.1;               // of the largest marginal, at an end of the values

/// Different stimuli with how often each outcome came of them.
struct Counted {
  std::vector<double> stimulus;
  std::vector<double> counts;  // (outcomes)
};

std::vector<Counted> counted(const QuestDefinition& d, const std::vector<SurfaceTrial>& trials) {
  std::map<std::vector<double>, std::vector<double>> all;
  for (const SurfaceTrial& trial : trials) {
    if (trial.stimulus.size() != d.stimulus.size() || trial.outcome >= d.outcomes) {
      throw std::invalid_argument(fmt::format(
          "a trial has {} stimulus variables and outcome {}; allowed: {}, and outcomes below {}",
          trial.stimulus.size(), trial.outcome, d.stimulus.size(), d.outcomes));
    }
    auto& counts = all[trial.stimulus];
    counts.resize(d.outcomes, 0.0);
    counts[trial.outcome] += 1.0;
  }
  std::vector<Counted> list;
  for (auto& [stimulus, counts] : all) {
    list.push_back({stimulus, std::move(counts)});
  }
  return list;
}

/// The posterior on cells of a box in the places of knots.
class Grid {
 public:
  Grid(const QuestDefinition& d, const std::vector<Counted>& data)
      : d_(d), data_(data), values_(d.parameters.size()), probabilities_(d.outcomes) {
    for (std::size_t i = 0; i < d.parameters.size(); ++i) {
      knots_.emplace_back(d.parameters[i]);
      values_[i] = knots_[i].value(0.0);
      if (knots_[i].last() > 0.0) {
        free_.push_back(i);
        low_.push_back(0.0);
        high_.push_back(knots_[i].last());
      }
    }
    if (free_.empty() || free_.size() > kMostSurfaceParameters) {
      throw std::invalid_argument(fmt::format("{} parameters have several values; allowed: 1 to {}",
                                              free_.size(), kMostSurfaceParameters));
    }
  }

  /// Fills the box's cells. @throws std::invalid_argument if no cell is possible
  void fill(std::size_t cells) {
    const double root = std::pow(static_cast<double>(cells), 1.0 / static_cast<double>(size()));
    steps_ = std::min(kMostSteps, static_cast<std::size_t>(root));
    std::size_t count = 1;
    for (std::size_t k = 0; k < size(); ++k) {
      count *= steps_;
    }
    weights_.resize(count);
    for (std::size_t cell = 0; cell < count; ++cell) {
      weights_[cell] = log_density(cell);
    }
    const double most = *std::max_element(weights_.begin(), weights_.end());
    if (!std::isfinite(most)) {
      throw std::invalid_argument("the answers are impossible for all values of the parameters");
    }
    double sum = 0.0;
    for (double& weight : weights_) {
      sum += weight = std::exp(weight - most);
    }
    for (double& weight : weights_) {
      weight /= sum;
    }
  }

  /// Draws the box around what is above nothing. @returns whether it stays about as large
  bool follow() {
    bool settled = true;
    for (std::size_t k = 0; k < size(); ++k) {
      const std::vector<double> m = marginal(k);
      const double nothing = kNothing * *std::max_element(m.begin(), m.end());
      const auto above = [nothing](double each) { return each > nothing; };
      const auto first = std::find_if(m.begin(), m.end(), above) - m.begin();
      const auto last = m.rend() - std::find_if(m.rbegin(), m.rend(), above);
      const double step = (high_[k] - low_[k]) / static_cast<double>(steps_);
      const double was = high_[k] - low_[k];
      const double end = knots_[free_[k]].last();
      const double from = low_[k];
      low_[k] = std::max(0.0, from + step * static_cast<double>(first - 1));
      high_[k] = std::min(end, from + step * static_cast<double>(last + 1));
      const double now = high_[k] - low_[k];
      settled = settled && now >= kSettled * was && now <= was / kSettled;
    }
    return settled;
  }

  SurfaceParameter parameter(std::size_t k) const {
    const Knots& knots = knots_[free_[k]];
    const std::vector<double> m = marginal(k);
    SurfaceParameter p;
    p.name = d_.parameters[free_[k]].name;
    double square = 0.0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      p.mean += m[i] * knots.value(place(k, i));
    }
    for (std::size_t i = 0; i < m.size(); ++i) {
      const double away = knots.value(place(k, i)) - p.mean;
      square += m[i] * away * away;
    }
    p.deviation = std::sqrt(square);
    p.low = knots.value(quantile_of(k, m, kOutsideInterval));
    p.high = knots.value(quantile_of(k, m, 1.0 - kOutsideInterval));
    const double edge = kEdge * *std::max_element(m.begin(), m.end());
    p.at_edge =
        (low_[k] == 0.0 && m.front() > edge) || (high_[k] == knots.last() && m.back() > edge);
    return p;
  }

  /// Cells at even steps of the posterior's sum.
  std::vector<std::vector<double>> draws() {
    std::vector<std::vector<double>> all;
    double sum = 0.0;
    for (std::size_t cell = 0; cell < weights_.size(); ++cell) {
      sum += weights_[cell];
      while (all.size() < kDraws && sum * kDraws > static_cast<double>(all.size()) + 0.5) {
        set_values(cell);
        all.push_back(values_);
      }
    }
    return all;
  }
  std::size_t size() const { return free_.size(); }

 private:
  double place(std::size_t k, std::size_t step) const {
    return low_[k] +
           (high_[k] - low_[k]) * (static_cast<double>(step) + 0.5) / static_cast<double>(steps_);
  }
  std::size_t step_of(std::size_t cell, std::size_t k) const {
    for (std::size_t i = 0; i < k; ++i) {
      cell /= steps_;
    }
    return cell % steps_;
  }
  /// @returns the weight of the prior
  double set_values(std::size_t cell) {
    double prior = 1.0;
    for (std::size_t k = 0; k < size(); ++k) {
      const double at = place(k, step_of(cell, k));
      values_[free_[k]] = knots_[free_[k]].value(at);
      prior *= knots_[free_[k]].weight(at);
    }
    return prior;
  }
  double log_density(std::size_t cell) {
    double sum = std::log(set_values(cell));
    for (const Counted& each : data_) {
      d_.model(each.stimulus.data(), values_.data(), probabilities_.data());
      for (std::size_t o = 0; o < each.counts.size(); ++o) {
        if (each.counts[o] > 0.0) {
          sum += each.counts[o] * std::log(std::max(0.0, probabilities_[o]));
        }
      }
    }
    return std::isnan(sum) ? -std::numeric_limits<double>::infinity() : sum;
  }
  std::vector<double> marginal(std::size_t k) const {
    std::vector<double> m(steps_, 0.0);
    for (std::size_t cell = 0; cell < weights_.size(); ++cell) {
      m[step_of(cell, k)] += weights_[cell];
    }
    return m;
  }
  double quantile_of(std::size_t k, const std::vector<double>& m, double share) const {
    double sum = 0.0;
    const double step = (high_[k] - low_[k]) / static_cast<double>(steps_);
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (sum + m[i] >= share) {
        return low_[k] + step * (static_cast<double>(i) + (share - sum) / m[i]);
      }
      sum += m[i];
    }
    return high_[k];
  }

  const QuestDefinition& d_;
  const std::vector<Counted>& data_;
  std::vector<Knots> knots_;        // (parameters)
  std::vector<std::size_t> free_;   // those with several values
  std::vector<double> low_, high_;  // (free) the box
  std::size_t steps_{0};            // of each side
  std::vector<double> weights_;     // (steps^free), the first parameter fastest; sum 1
  std::vector<double> values_;      // (parameters)
  std::vector<double> probabilities_;
};

}  // namespace

SurfaceFit fit_surface(const QuestDefinition& definition, const std::vector<SurfaceTrial>& trials) {
  if (trials.empty()) {
    throw std::invalid_argument("there are no trials");
  }
  const std::vector<Counted> data = counted(definition, trials);
  Grid grid(definition, data);
  for (int grids = 0; grids < kMostGrids; ++grids) {
    grid.fill(kSearchCells);
    if (grid.follow()) {
      break;
    }
  }
  grid.fill(kFinalCells);
  SurfaceFit fit;
  fit.trials = trials.size();
  for (std::size_t k = 0; k < grid.size(); ++k) {
    fit.parameters.push_back(grid.parameter(k));
  }
  fit.draws = grid.draws();
  return fit;
}

}  // namespace haptrial::analysis
