#include "analysis/statistics/design/covariate_tests.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <vector>

#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "analysis/statistics/relation/regression.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kLevel = 0.95;
constexpr const char* kNobody = "nobody has a value of the covariate";
constexpr const char* kSamePeople =
    "the same people are compared, and what they bring along drops out of their difference";

/// A value of a participant who has the covariate.
struct Row {
  std::size_t subject;
  std::size_t cell;  // of the two sides: 0 is b, 1 is a
  double covariate;
  double value;
};

void add_row(const DesignTable& table, const Covariate& covariate, std::size_t subject,
             std::size_t cell, double value, std::vector<Row>& rows) {
  const auto found = covariate.values.find(table.subjects[subject]);
  if (found != covariate.values.end()) {
    rows.push_back({subject, cell, found->second, value});
  }
}

void centre(std::vector<Row>& rows) {
  double mean = 0.0;
  for (const Row& row : rows) {
    mean += row.covariate / static_cast<double>(rows.size());
  }
  for (Row& row : rows) {
    row.covariate -= mean;
  }
}

std::vector<double> values_of_rows(const std::vector<Row>& rows) {
  std::vector<double> values;
  for (const Row& row : rows) {
    values.push_back(row.value);
  }
  return values;
}

Defined<TTest> test_of(const Defined<Regression>& fit, std::size_t which, Tail tail) {
  if (!fit) {
    return Undefined{fit.because()};
  }
  const Coefficient& c = fit->coefficients[which];
  return t_test_of(c.estimate, c.error, c.df, tail, kLevel);
}

/// Values of whole participants, or of everybody if the factor is between them.
std::vector<Row> complete_rows(const DesignTable& table, const Covariate& covariate) {
  std::vector<Row> rows;
  for (const std::size_t subject : table.complete()) {
    for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
      if (const auto& mean = table.means[subject][cell]) {
        add_row(table, covariate, subject, cell, *mean, rows);
      }
    }
  }
  centre(rows);
  return rows;
}

/// The level against the last one: sums over the levels are 0.
double contrast_of(std::size_t cell, std::size_t level, std::size_t last) {
  return cell == level ? 1.0 : cell == last ? -1.0 : 0.0;
}

/// Contrasts of the levels, then the covariate.
MatrixXd between_predictors(const std::vector<Row>& rows, std::size_t levels) {
  const auto contrasts = static_cast<Index>(levels - 1);
  MatrixXd x(std::ssize(rows), contrasts + 1);
  for (Index i = 0; i < x.rows(); ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    for (Index k = 0; k < contrasts; ++k) {
      x(i, k) = contrast_of(row.cell, static_cast<std::size_t>(k), levels - 1);
    }
    x(i, contrasts) = row.covariate;
  }
  return x;
}

/// Contrasts of the levels, their products with the covariate, and participants but the first: the
/// covariate itself lies in what they differ by.
MatrixXd within_predictors(const std::vector<Row>& rows, std::size_t levels) {
  const auto contrasts = static_cast<Index>(levels - 1);
  const Index people = std::ssize(rows) / static_cast<Index>(levels);
  MatrixXd x = MatrixXd::Zero(std::ssize(rows), 2 * contrasts + people - 1);
  for (Index i = 0; i < x.rows(); ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    for (Index k = 0; k < contrasts; ++k) {
      x(i, k) = contrast_of(row.cell, static_cast<std::size_t>(k), levels - 1);
      x(i, contrasts + k) = x(i, k) * row.covariate;
    }
    const Index person = i / static_cast<Index>(levels);
    if (person > 0) {
      x(i, 2 * contrasts + person - 1) = 1.0;
    }
  }
  return x;
}

}  // namespace

Defined<TTest> adjusted_test(const DesignTable& table, const Sides& sides,
                             const Covariate& covariate, Tail tail) {
  if (sides.paired) {
    return Undefined{kSamePeople};
  }
  if (sides.strata.size() > 1) {
    return Undefined{"other groups lie across both sides"};
  }
  std::vector<Row> rows;
  for (std::size_t i = 0; i < sides.a.size(); ++i) {
    add_row(table, covariate, sides.subjects_a[i], 1, sides.a[i], rows);
  }
  for (std::size_t i = 0; i < sides.b.size(); ++i) {
    add_row(table, covariate, sides.subjects_b[i], 0, sides.b[i], rows);
  }
  if (rows.empty()) {
    return Undefined{kNobody};
  }
  centre(rows);
  MatrixXd x(std::ssize(rows), 2);
  for (Index i = 0; i < x.rows(); ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    x(i, 0) = row.covariate;
    x(i, 1) = static_cast<double>(row.cell);
  }
  return test_of(linear_regression(x, values_of_rows(rows)), 2, tail);
}

Defined<EffectTest> adjusted_effect(const DesignTable& table, const Covariate& covariate) {
  const std::size_t levels = table.cells.size();
  if (table.factors.size() != 1 || levels < 2) {
    return Undefined{"an analysis of covariance is for one factor"};
  }
  const Factor& factor = table.factors.front();
  const std::vector<Row> rows = complete_rows(table, covariate);
  if (rows.empty()) {
    return Undefined{kNobody};
  }
  const MatrixXd x =
      factor.within ? within_predictors(rows, levels) : between_predictors(rows, levels);
  const auto model = mixed_model(values_of_rows(rows), x, {});
  if (!model) {
    return Undefined{model.because()};
  }
  const auto contrasts = static_cast<Index>(levels - 1);
  MatrixXd weights = MatrixXd::Zero(contrasts, x.cols() + 1);
  const Index first = factor.within ? 1 + contrasts : 1;  // of the products, or of the levels
  weights.middleCols(first, contrasts).setIdentity();
  const auto joint = joint_test(*model, weights);
  if (!joint) {
    return Undefined{joint.because()};
  }
  const auto df_error = static_cast<double>(x.rows() - x.cols() - 1);
  EffectTest effect{
      factor.within ? fmt::format("{} × {}", factor.name, covariate.name) : factor.name,
      fmt::format("analysis of covariance, {} {}", covariate.name,
                  factor.within ? "beside each level" : "held"),
      joint->f,
      joint->df_numerator,
      df_error,
      joint->p,
      std::nullopt};
  effect.size = partial_eta_squared(joint->f, joint->df_numerator, df_error);
  return effect;
}

}  // namespace haptrial::analysis
