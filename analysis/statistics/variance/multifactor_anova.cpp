#include "analysis/statistics/variance/multifactor_anova.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Mask = unsigned;  // a bit for each factor

/// The contrasts of the factors in the mask; the mean over all others.
MatrixXd contrasts_of(const std::vector<std::size_t>& levels, Mask mask) {
  MatrixXd all = MatrixXd::Ones(1, 1);
  for (std::size_t f = 0; f < levels.size(); ++f) {
    all = within::product(
        all, (mask >> f & 1U) != 0 ? within::contrasts(levels[f]) : within::constant(levels[f]));
  }
  return all;
}

/// Columns of an effect between participants: products of its factors' contrasts.
MatrixXd columns_of(const MultifactorTable& table, Mask mask) {
  const auto n = static_cast<Index>(table.groups.size());
  MatrixXd all = MatrixXd::Ones(n, 1);
  for (std::size_t f = 0; f < table.between.size(); ++f) {
    if ((mask >> f & 1U) == 0) {
      continue;
    }
    const MatrixXd contrasts = within::contrasts(table.between[f]);
    MatrixXd next(n, all.cols() * contrasts.cols());
    for (Index i = 0; i < n; ++i) {
      const auto level = static_cast<Index>(table.groups[static_cast<std::size_t>(i)][f]);
      next.row(i) = within::product(all.row(i), contrasts.row(level));
    }
    all = std::move(next);
  }
  return all;
}

/// Columns of all effects between participants but one.
MatrixXd design_without(const MultifactorTable& table, Mask left_out) {
  const auto n = static_cast<Index>(table.groups.size());
  MatrixXd design(n, 0);
  for (Mask mask = 0; mask < 1U << table.between.size(); ++mask) {
    if (mask != left_out) {
      const MatrixXd columns = columns_of(table, mask);
      design.conservativeResize(n, design.cols() + columns.cols());
      design.rightCols(columns.cols()) = columns;
    }
  }
  return design;
}

MatrixXd residuals(const MatrixXd& design, const MatrixXd& scores) {
  return design.cols() == 0
             ? scores
             : MatrixXd(scores - design * design.colPivHouseholderQr().solve(scores));
}

/// The squares of scores along columns of full rank: what these explain.
double squares_along(const MatrixXd& columns, const MatrixXd& scores) {
  const MatrixXd directions =
      columns.householderQr().householderQ() * MatrixXd::Identity(columns.rows(), columns.cols());
  return (directions.transpose() * scores).squaredNorm();
}

std::vector<std::size_t> factors_of(Mask mask) {
  std::vector<std::size_t> factors;
  for (std::size_t f = 0; mask >> f != 0; ++f) {
    if ((mask >> f & 1U) != 0) {
      factors.push_back(f);
    }
  }
  return factors;
}

class Analysis {
 public:
  explicit Analysis(const MultifactorTable& table)
      : table_(table),
        full_(design_without(table, ~0U)),
        rounding_(within::rounding_squares(table.values)),
        problem_(problem_of()) {}

  /// Why nothing is defined; empty if effects are.
  const std::string& problem() const { return problem_; }

  Defined<WithinEffect> tested(Mask within_mask, Mask between_mask) const {
    const MatrixXd scores = scores_of(within_mask);
    const MatrixXd error = residuals(full_, scores);
    const MatrixXd columns = columns_of(table_, between_mask);
    const MatrixXd own = residuals(design_without(table_, between_mask), columns);
    const auto df = static_cast<double>(scores.cols() * columns.cols());
    auto test = within::tested(squares_along(own, scores), df, error.transpose() * error,
                               static_cast<double>(full_.rows() - full_.cols()), rounding_);
    return test || within_mask != 0 || test.because() == kBeyondDouble
               ? test
               : Undefined{"the values do not vary within any group"};
  }

 private:
  std::string problem_of() const {
    const auto alone = [](std::size_t levels) { return levels < 2; };
    if (std::ranges::any_of(table_.within, alone) || std::ranges::any_of(table_.between, alone)) {
      return "a factor has fewer than two levels";
    }
    if (auto problem = problem_of_values(); !problem.empty()) {
      return problem;
    }
    if (full_.colPivHouseholderQr().rank() < full_.cols()) {
      return "a combination of groups has no participant";
    }
    return full_.rows() > full_.cols() ? "" : "there is one participant in every group";
  }

  std::string problem_of_values() const {
    if (table_.values.size() < 2) {
      return "fewer than two participants have a mean in every condition";
    }
    const auto cells = std::accumulate(table_.within.begin(), table_.within.end(), std::size_t{1},
                                       std::multiplies{});
    for (const auto& row : table_.values) {
      if (row.size() != cells) {
        return "a participant lacks a condition";
      }
      if (!std::ranges::all_of(row, [](double v) { return std::isfinite(v); })) {
        return "a value is not a finite number";
      }
    }
    return {};
  }

  /// Contrasts lose each participant's own offset; means keep it, less one that all have.
  MatrixXd scores_of(Mask within_mask) const {
    const MatrixXd contrasts = contrasts_of(table_.within, within_mask);
    if (within_mask != 0) {
      return within::scores(table_.values, contrasts);
    }
    const double origin = table_.values.front().front();
    MatrixXd means(full_.rows(), 1);
    for (Index i = 0; i < means.rows(); ++i) {
      const auto& row = table_.values[static_cast<std::size_t>(i)];
      const auto values = Eigen::Map<const Eigen::VectorXd>(row.data(), contrasts.rows());
      means(i, 0) = (values.array() - origin).matrix().dot(contrasts.col(0));
    }
    return means;
  }

  const MultifactorTable& table_;
  MatrixXd full_;
  double rounding_;
  std::string problem_;
};

}  // namespace

std::vector<MultifactorEffect> multifactor_anova(const MultifactorTable& table) {
  std::vector<MultifactorEffect> effects;
  const Mask between = 1U << table.between.size(), within = 1U << table.within.size();
  const Analysis analysis(table);
  for (Mask w = 0; w < within; ++w) {
    for (Mask b = w == 0 ? 1 : 0; b < between; ++b) {
      effects.push_back({factors_of(w), factors_of(b),
                         analysis.problem().empty()
                             ? analysis.tested(w, b)
                             : Defined<WithinEffect>(Undefined{analysis.problem()})});
    }
  }
  std::ranges::stable_sort(effects, {}, [](const MultifactorEffect& effect) {
    return effect.within.size() + effect.between.size();
  });
  return effects;
}

}  // namespace haptrial::analysis
