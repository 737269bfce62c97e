#include "analysis/psychometric/models/fisher_scoring.h"

#include <cmath>

#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {

std::optional<ScoringMaximum> fisher_scoring(const ScoredLikelihood& likelihood,
                                             const Eigen::VectorXd& start) {
  constexpr int kMost = 500, kHalvings = 40;
  Eigen::VectorXd p = start;
  auto point = likelihood(p);
  for (int step = 0; point && step < kMost; ++step) {
    const auto change = solve_positive(point->information, point->slope);
    if (!change) {
      return std::nullopt;
    }
    const double promise = 0.5 * change->col(0).dot(point->slope);
    if (promise < 1e-18 * (1.0 + std::abs(point->value))) {
      return ScoringMaximum{p, *point};
    }
    double part = 1.0;
    for (int i = 0; i < kHalvings; ++i, part *= 0.5) {
      const Eigen::VectorXd next = p + part * change->col(0);
      const auto there = likelihood(next);
      if (there && there->value >= point->value - 1e-13 * std::abs(point->value)) {
        p = next;
        point = there;
        break;
      }
    }
    if (p.cwiseAbs().maxCoeff() > 50.0) {
      return std::nullopt;  // it rises without end
    }
  }
  return std::nullopt;
}

}  // namespace haptrial::analysis
