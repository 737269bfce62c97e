#include "analysis/statistics/variance/multifactor_anova.h"

#include <Eigen/QR>
#include <algorithm>

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
        rounding_(within::rounding_squares(table.values)) {
    rank_ = full_.colPivHouseholderQr().rank();
  }

  Defined<WithinEffect> tested(Mask within_mask, Mask between_mask) const {
    if (rank_ < full_.cols()) {
      return Undefined{"a combination of groups has no participant"};
    }
    const auto df_rows = static_cast<double>(full_.rows() - rank_);
    if (df_rows < 1.0) {
      return Undefined{"there is one participant in every group"};
    }
    const MatrixXd scores = scores_of(within_mask);
    const MatrixXd error = residuals(full_, scores);
    const MatrixXd without = residuals(design_without(table_, between_mask), scores);
    const double squares = without.squaredNorm() - error.squaredNorm();
    const auto df = static_cast<double>(scores.cols() * columns_of(table_, between_mask).cols());
    return within::tested(squares, df, error.transpose() * error, df_rows, rounding_);
  }

 private:
  /// Contrasts lose each participant's own offset; means keep it.
  MatrixXd scores_of(Mask within_mask) const {
    const MatrixXd contrasts = contrasts_of(table_.within, within_mask);
    if (within_mask != 0) {
      return within::scores(table_.values, contrasts);
    }
    MatrixXd means(full_.rows(), 1);
    for (Index i = 0; i < means.rows(); ++i) {
      const auto& row = table_.values[static_cast<std::size_t>(i)];
      means(i, 0) =
          Eigen::Map<const Eigen::VectorXd>(row.data(), contrasts.rows()).dot(contrasts.col(0));
    }
    return means;
  }

  const MultifactorTable& table_;
  MatrixXd full_;
  Index rank_{0};
  double rounding_;
};

}  // namespace

std::vector<MultifactorEffect> multifactor_anova(const MultifactorTable& table) {
  std::vector<MultifactorEffect> effects;
  const Mask between = 1U << table.between.size(), within = 1U << table.within.size();
  const Analysis analysis(table);
  for (Mask b = 0; b < between; ++b) {
    for (Mask w = 0; w < within; ++w) {
      if (b != 0 || w != 0) {
        effects.push_back({factors_of(w), factors_of(b), analysis.tested(w, b)});
      }
    }
  }
  std::ranges::stable_sort(effects, {}, [](const MultifactorEffect& effect) {
    return effect.within.size() + effect.between.size();
  });
  return effects;
}

}  // namespace haptrial::analysis
