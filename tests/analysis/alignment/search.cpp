#include "tests/analysis/alignment/search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::analysis::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A pair that a step visits, from where it starts, and the weight of its error.
struct Visit {
  int down, across;
  double weight;
};

struct Step {
  bool is_straight;
  std::vector<Visit> visits;
};

const std::vector<Step>& steps_of(StepPattern pattern) {
  static const std::vector<Step> symmetric_1{
      {true, {{1, 1, 1.0}}}, {false, {{1, 0, 1.0}}}, {false, {{0, 1, 1.0}}}};
  static const std::vector<Step> symmetric_2{
      {true, {{1, 1, 2.0}}}, {false, {{1, 0, 1.0}}}, {false, {{0, 1, 1.0}}}};
  static const std::vector<Step> asymmetric{
      {true, {{1, 1, 1.0}}}, {false, {{1, 0, 1.0}}}, {false, {{1, 2, 1.0}}}};
  static const std::vector<Step> symmetric_p1{{false, {{1, 1, 2.0}, {1, 2, 1.0}}},
                                              {false, {{1, 1, 2.0}, {2, 1, 1.0}}},
                                              {true, {{1, 1, 2.0}}}};
  switch (pattern) {
    case StepPattern::kSymmetric2:
      return symmetric_2;
    case StepPattern::kAsymmetric:
      return asymmetric;
    case StepPattern::kSymmetricP1:
      return symmetric_p1;
    default:
      return symmetric_1;
  }
}

double error(const Curve& a, const Curve& b, const AlignmentOptions& o, std::size_t i,
             std::size_t j) {
  return o.force_weight * std::pow(std::abs(a.force[i] - b.force[j]), o.power) +
         o.slope_weight * std::pow(std::abs(a.slope[i] - b.slope[j]), o.power);
}

}  // namespace

ExhaustiveSearch::ExhaustiveSearch(const Curve& target, const Curve& applied,
                                   const AlignmentOptions& options)
    : options_(options),
      rows_(static_cast<int>(target.force.size())),
      columns_(static_cast<int>(applied.force.size())),
      errors_(target.force.size()),
      cost_by_end_(applied.force.size(), kInfinity),
      cost_(kInfinity) {
  for (std::size_t i = 0; i < target.force.size(); ++i) {
    for (std::size_t j = 0; j < applied.force.size(); ++j) {
      errors_[i].push_back(error(target, applied, options, i, j));
    }
  }
  for (int start = 0; start < (options.open_begin ? columns_ : 1); ++start) {
    if (is_inside(0, start)) {
      visit(0, start, errors_[0][static_cast<std::size_t>(start)]);
    }
  }
  const bool twice =
      options.pattern == StepPattern::kSymmetric2 || options.pattern == StepPattern::kSymmetricP1;
  double least = kInfinity;
  for (int end = 0; end < columns_; ++end) {
    const double cost = cost_by_end_[static_cast<std::size_t>(end)];
    const double measure = twice ? cost / (rows_ + end + 1) : cost;
    if (measure <= least) {
      least = measure, cost_ = cost;
    }
  }
}

bool ExhaustiveSearch::is_inside(int row, int column) const {
  if (row < 0 || column < 0 || row >= rows_ || column >= columns_) {
    return false;
  }
  if (!options_.window || rows_ == 1 || columns_ == 1) {
    return true;
  }
  const double longer = std::max(rows_, columns_) - 1, shorter = std::min(rows_, columns_) - 1;
  const double apart = std::abs(static_cast<double>(row) / (rows_ - 1) -
                                static_cast<double>(column) / (columns_ - 1));
  // As shares of the whole: the window, or half a sample of the shorter curve.
  const double most = std::max(static_cast<double>(*options_.window) / longer, 0.5 / shorter);
  return apart <= most + 1e-9;
}

void ExhaustiveSearch::visit(int row, int column, double cost) {
  if (row == rows_ - 1 && (options_.open_end || column == columns_ - 1)) {
    double& least = cost_by_end_[static_cast<std::size_t>(column)];
    least = std::min(least, cost);
  }
  for (const Step& step : steps_of(options_.pattern)) {
    double next = cost + (step.is_straight ? 0.0 : options_.penalty);
    bool is_legal = true;
    for (const Visit& v : step.visits) {
      is_legal = is_legal && is_inside(row + v.down, column + v.across);
      if (!is_legal) {
        break;
      }
      next += v.weight * errors_[static_cast<std::size_t>(row + v.down)]
                                [static_cast<std::size_t>(column + v.across)];
    }
    if (is_legal) {
      visit(row + step.visits.back().down, column + step.visits.back().across, next);
    }
  }
}

double cost_of_legal_path(const Curve& target, const Curve& applied,
                          const AlignmentOptions& options, const std::vector<PathPoint>& path) {
  const double illegal = std::nan("");
  if (path.empty() || path.front().target != 0 || path.back().target + 1 != target.force.size() ||
      (!options.open_begin && path.front().applied != 0) ||
      (!options.open_end && path.back().applied + 1 != applied.force.size()) ||
      path.back().applied >= applied.force.size()) {
    return illegal;
  }
  double cost = error(target, applied, options, path[0].target, path[0].applied);
  for (std::size_t k = 0; k + 1 < path.size();) {
    const auto fits = [&](const Step& step) {
      for (std::size_t v = 0; v < step.visits.size(); ++v) {
        if (k + v + 1 >= path.size()) {
          return false;
        }
        const int down = static_cast<int>(path[k + v + 1].target - path[k].target);
        const int across = static_cast<int>(path[k + v + 1].applied - path[k].applied);
        if (down != step.visits[v].down || across != step.visits[v].across) {
          return false;
        }
      }
      return true;
    };
    const auto& steps = steps_of(options.pattern);  // longer ones first
    const auto step = std::find_if(steps.begin(), steps.end(), fits);
    if (step == steps.end()) {
      return illegal;
    }
    for (const Visit& v : step->visits) {
      ++k;
      cost += v.weight * error(target, applied, options, path[k].target, path[k].applied);
    }
    cost += step->is_straight ? 0.0 : options.penalty;
  }
  return cost;
}

}  // namespace haptrial::analysis::test
