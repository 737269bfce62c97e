#include "analysis/statistics/relation/variance_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Slopes = RestrictedLikelihood::Slopes;

constexpr double kFirst = -8.0, kLast = 10.0;  // log10 of a rho

/// One rho after the other, the others held; several lowest places are told apart by this alone.
VectorXd scanned(const RestrictedLikelihood& likelihood) {
  const double step = likelihood.terms() == 1 ? 0.25 : 0.5;
  VectorXd best = VectorXd::Zero(likelihood.terms());
  double least = likelihood.value(best).criterion;
  for (Index k = 0; k < likelihood.terms(); ++k) {
    VectorXd here = best;
    for (double power = kFirst; power <= kLast; power += step) {
      here[k] = std::pow(10.0, power);
      if (const double found = likelihood.value(here).criterion; found < least) {
        least = found;
        best = here;
      }
    }
  }
  return best;
}

/// The rhos that may move: those above 0, and those at 0 along which the criterion falls.
std::vector<Index> free_of(const Slopes& s) {
  std::vector<Index> free;
  for (Index k = 0; k < s.rho.size(); ++k) {
    if (s.rho[k] > 0.0 || s.slope[k] < 0.0) {
      free.push_back(k);
    }
  }
  return free;
}

/// Minus the inverse of the matrix times the slope; nothing if it is not positive definite.
std::optional<VectorXd> descent(const MatrixXd& matrix, const VectorXd& slope) {
  const VectorXd diagonal = matrix.diagonal();
  if (!(diagonal.minCoeff() > 0.0)) {
    return std::nullopt;
  }
  const VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const std::optional<MatrixXd> solved =
      solve_positive(scale.asDiagonal() * matrix * scale.asDiagonal(), scale.cwiseProduct(slope));
  if (!solved) {
    return std::nullopt;
  }
  return VectorXd(-scale.cwiseProduct(solved->col(0)));
}

struct Step {
  VectorXd change;       // (K)
  double expected{0.0};  // fall of the criterion that the slope promises
};

/// Newton's step; Fisher's, which always descends, if the criterion is not convex.
Step step_of(const Slopes& s, bool fisher) {
  Step step{VectorXd::Zero(s.rho.size())};
  const std::vector<Index> free = free_of(s);
  if (free.empty()) {
    return step;
  }
  const VectorXd slope = s.slope(free);
  std::optional<VectorXd> change;
  if (!fisher) {
    change = descent(s.hessian(free, free), slope);
  }
  if (!change) {
    // The diagonal alone counts, so that the step still descends when a rho is stopped at 0.
    const VectorXd information = s.expected(free, free).diagonal();
    change = -slope.cwiseQuotient(information.cwiseMax(std::numeric_limits<double>::min()));
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    step.change[free[i]] = (*change)[static_cast<Index>(i)];
  }
  step.expected = -slope.dot(*change);
  return step;
}

/// Slopes after a part of the step, if the value there is lower.
std::optional<Slopes> lower(const RestrictedLikelihood& likelihood, const Slopes& s,
                            const Step& step) {
  constexpr int kHalvings = 40;
  double part = 1.0;
  for (int i = 0; i < kHalvings; ++i, part *= 0.5) {
    const VectorXd rho = (s.rho + part * step.change).cwiseMax(0.0);
    if (likelihood.value(rho).criterion < s.criterion) {
      return likelihood.at(rho);
    }
  }
  return std::nullopt;
}

/// The slope along the free rhos, each in units of its own.
double steepness(const Slopes& s) {
  double sum = 0.0;
  for (const Index k : free_of(s)) {
    sum += std::pow(s.slope[k] * std::max(s.rho[k], 1e-12), 2);
  }
  return std::sqrt(sum);
}

/// The criterion tells no more here: its slope is brought to zero.
Slopes polished(const RestrictedLikelihood& likelihood, Slopes s) {
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps; ++i) {
    const VectorXd rho = (s.rho + step_of(s, false).change).cwiseMax(0.0);
    Slopes next = likelihood.at(rho);
    if (!(steepness(next) < steepness(s))) {
      break;
    }
    s = std::move(next);
  }
  return s;
}

}  // namespace

std::optional<Slopes> lowest_point(const RestrictedLikelihood& likelihood) {
  constexpr int kSteps = 200;
  constexpr double kSmall = 1e-8;  // of the criterion
  const double limit = std::pow(10.0, kLast);
  Slopes s = likelihood.at(scanned(likelihood));
  for (int i = 0; i < kSteps; ++i) {
    const Step step = step_of(s, false);
    if (step.expected <= kSmall) {
      break;
    }
    auto next = lower(likelihood, s, step);
    if (!next) {
      next = lower(likelihood, s, step_of(s, true));
    }
    if (!next) {
      break;
    }
    s = std::move(*next);
  }
  s = polished(likelihood, std::move(s));
  if (s.rho.size() > 0 && s.rho.maxCoeff() >= limit) {
    return std::nullopt;
  }
  return s;
}

}  // namespace haptrial::analysis
