#include "analysis/statistics/variance/repeated_anova.h"

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

using within::Table;

Defined<WithinEffect> effect(const Table& table, const Eigen::MatrixXd& contrasts) {
  const Eigen::MatrixXd scores = within::scores(table, contrasts);
  const auto n = static_cast<double>(table.size());
  return within::tested(n * scores.colwise().mean().squaredNorm(),
                        static_cast<double>(contrasts.cols()), within::products(scores), n - 1.0,
                        within::rounding_squares(table));
}

// The squares of the participants' means, times the number of conditions.
double squares_of_participants(const Table& table) {
  std::vector<double> means;
  for (const auto& row : table) {
    double sum = 0.0;
    for (const double value : row) {
      sum += value - table.front().front();
    }
    means.push_back(sum / static_cast<double>(row.size()));
  }
  return static_cast<double>(table.front().size()) * moments(means)->squares;
}

}  // namespace

Defined<RepeatedAnova> repeated_measures_anova(const Table& table) {
  if (auto problem = within::problem(table); !problem.empty()) {
    return Undefined{std::move(problem)};
  }
  const auto condition = effect(table, within::contrasts(table.front().size()));
  if (!condition) {
    return Undefined{condition.because()};
  }
  RepeatedAnova result{table.size(), table.front().size()};
  result.f = condition->f;
  result.df_condition = condition->df;
  result.df_error = condition->df_error;
  result.squares_condition = condition->squares;
  result.squares_participants = squares_of_participants(table);
  result.squares_error = condition->squares_error;
  result.p = condition->p;
  result.epsilon = condition->sphericity.greenhouse_geisser;
  result.p_corrected = condition->p_greenhouse_geisser;
  result.partial_eta_squared = condition->partial_eta_squared;
  result.sphericity = condition->sphericity;
  result.p_huynh_feldt = condition->p_huynh_feldt;
  return result;
}

}  // namespace haptrial::analysis
