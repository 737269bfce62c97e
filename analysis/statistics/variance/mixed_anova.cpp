#include "analysis/statistics/variance/mixed_anova.h"

#include <string>

namespace haptrial::analysis {
namespace {

using within::Table;

std::string problem(const std::vector<Table>& groups, const Table& all) {
  if (groups.size() < 2) {
    return "there are fewer than two groups";
  }
  for (const auto& group : groups) {
    if (group.empty()) {
      return "a group is empty";
    }
  }
  if (all.size() == groups.size()) {
    return "every group has a single participant";
  }
  return within::problem(all);
}

// The analysis of the participants' means, with squares of all values.
Defined<Anova> between_groups(const std::vector<Table>& groups, double rounding) {
  const double origin = groups.front().front().front();
  const auto conditions = static_cast<double>(groups.front().front().size());
  std::vector<std::vector<double>> means;
  for (const auto& group : groups) {
    means.emplace_back();
    for (const auto& row : group) {
      double sum = 0.0;
      for (const double value : row) {
        sum += value - origin;
      }
      means.back().push_back(sum / conditions);
    }
  }
  const auto anova = one_way_anova(means);
  if (!anova) {
    return anova;
  }
  Anova result = *anova;
  result.squares_between *= conditions;
  result.squares_within *= conditions;
  if (result.squares_within <= rounding) {
    return Undefined{"the values do not vary within any group"};
  }
  return result;
}

// Contrast scores of each group: number, mean, and the error pooled over groups.
struct Scores {
  Eigen::VectorXd counts;  // (groups)
  Eigen::MatrixXd means;   // (groups x contrasts)
  Eigen::MatrixXd error;   // (contrasts x contrasts)
};

Scores group_scores(const std::vector<Table>& groups, const Eigen::MatrixXd& contrasts) {
  const auto count = static_cast<Eigen::Index>(groups.size());
  const Eigen::Index width = contrasts.cols();
  Scores result{Eigen::VectorXd(count), Eigen::MatrixXd(count, width),
                Eigen::MatrixXd::Zero(width, width)};
  for (Eigen::Index g = 0; g < count; ++g) {
    const Eigen::MatrixXd scores = within::scores(groups[static_cast<std::size_t>(g)], contrasts);
    result.counts(g) = static_cast<double>(scores.rows());
    result.means.row(g) = scores.colwise().mean();
    result.error += within::products(scores);
  }
  return result;
}

double squares_of_condition(const Scores& scores, Squares squares) {
  if (squares == Squares::kMarginal) {  // variance of the plain mean of group means
    const auto groups = static_cast<double>(scores.counts.size());
    const double per_participant = scores.counts.cwiseInverse().sum() / (groups * groups);
    return scores.means.colwise().mean().squaredNorm() / per_participant;
  }
  return (scores.counts.transpose() * scores.means).squaredNorm() / scores.counts.sum();
}

double squares_of_interaction(const Scores& scores) {
  const Eigen::RowVectorXd mean = scores.counts.transpose() * scores.means / scores.counts.sum();
  return (scores.counts.transpose() * (scores.means.rowwise() - mean).cwiseAbs2()).sum();
}

}  // namespace

Defined<MixedAnova> mixed_anova(const std::vector<Table>& groups, Squares squares) {
  Table all;
  for (const auto& group : groups) {
    all.insert(all.end(), group.begin(), group.end());
  }
  if (auto why = problem(groups, all); !why.empty()) {
    return Undefined{std::move(why)};
  }
  const std::size_t conditions = all.front().size();
  const Scores scores = group_scores(groups, within::contrasts(conditions));
  const auto df_condition = static_cast<double>(conditions - 1);
  const auto df_group = static_cast<double>(groups.size() - 1);
  const auto df_rows = static_cast<double>(all.size() - groups.size());
  const double rounding = within::rounding_squares(all);

  MixedAnova result{all.size(), groups.size(), conditions};
  result.group = between_groups(groups, rounding);
  result.condition = within::tested(squares_of_condition(scores, squares), df_condition,
                                    scores.error, df_rows, rounding);
  result.interaction = within::tested(squares_of_interaction(scores), df_condition * df_group,
                                      scores.error, df_rows, rounding);
  return result;
}

}  // namespace haptrial::analysis
