#include "analysis/psychophysics/study/population.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "analysis/psychophysics/fit/function_fit.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kFewest = 5;  // participants

/// Answers at one level of one participant under one condition.
struct Row {
  double x{0.0};
  int yes{0}, trials{0};
  std::size_t participant{0};
  double side{0.0};  // -1/2, +1/2: condition
};

std::vector<std::string> conditions_of(const std::vector<AnsweredSeries>& series) {
  std::set<std::string> names;
  for (const AnsweredSeries& each : series) {
    names.insert(each.condition());
  }
  return {names.begin(), names.end()};
}

std::vector<Row> rows_of(const std::vector<AnsweredSeries>& series,
                         const std::vector<std::string>& conditions,
                         const psychometric::Axis& axis) {
  std::vector<Row> rows;
  std::vector<std::string> people;
  for (const AnsweredSeries& each : series) {
    if (people.empty() || people.back() != each.participant) {
      people.push_back(each.participant);
    }
    const double side = conditions.size() < 2               ? 0.0
                        : each.condition() == conditions[0] ? -0.5
                                                            : 0.5;
    for (const TrialBlock& block : blocks_of(each)) {
      const double x = axis.at(block.level);
      if (std::isfinite(x)) {
        rows.push_back({x, block.correct, block.total, people.size() - 1, side});
      }
    }
  }
  return rows;
}

void standardise(std::vector<Row>& rows, PopulationModel& made) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const Row& row : rows) {
    sum += row.trials * row.x;
    count += row.trials;
  }
  made.centre = sum / count;
  for (const Row& row : rows) {
    squares += row.trials * (row.x - made.centre) * (row.x - made.centre);
  }
  made.scale = std::sqrt(squares / count);
  for (Row& row : rows) {
    row.x = (row.x - made.centre) / made.scale;
  }
}

BinomialData data_of(const std::vector<Row>& rows, bool two) {
  BinomialData data;
  data.predictors.resize(static_cast<Eigen::Index>(rows.size()), two ? 3 : 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    data.yes.push_back(rows[i].yes);
    data.trials.push_back(rows[i].trials);
    data.predictors(at, 0) = rows[i].x;
    if (two) {
      data.predictors(at, 1) = rows[i].side;
      data.predictors(at, 2) = rows[i].side * rows[i].x;
    }
  }
  return data;
}

int degrees_of_freedom(const PopulationModel& made) {
  return static_cast<int>(made.model.participants.size()) - 1;
}

/// Half of a 95 % interval over its standard error.
double half_width(const PopulationModel& made) {
  return t_quantile(0.975, degrees_of_freedom(made));
}

/// Student's t in place of the normal distribution, as participants are what varies.
void judge_by_participants(PopulationModel& made) {
  for (BinomialCoefficient& c : made.model.fixed.coefficients) {
    c.p = 2.0 * t_upper_tail(std::abs(c.z), degrees_of_freedom(made));
    c.low = c.estimate - half_width(made) * c.error;
    c.high = c.estimate + half_width(made) * c.error;
  }
}

/// Crossing of a condition, brought back to the axis.
Defined<EqualityPoint> crossing(const PopulationModel& made, double side) {
  const auto n = static_cast<Eigen::Index>(made.model.fixed.coefficients.size());
  Eigen::VectorXd intercept = Eigen::VectorXd::Zero(n), slope = Eigen::VectorXd::Zero(n);
  intercept[0] = slope[1] = 1.0;
  if (n > 2) {
    intercept[2] = slope[3] = side;
  }
  const auto z = equality_point(made.model.fixed, BinomialLink::kProbit, intercept, slope);
  if (!z) {
    return z;
  }
  EqualityPoint x = *z;
  x.point = made.centre + made.scale * z->point;
  x.point_error = made.scale * z->point_error;
  x.jnd = made.scale * z->jnd;
  x.jnd_error = made.scale * z->jnd_error;
  x.point_low = x.point - half_width(made) * x.point_error;
  x.point_high = x.point + half_width(made) * x.point_error;
  x.jnd_low = x.jnd - half_width(made) * x.jnd_error;
  x.jnd_high = x.jnd + half_width(made) * x.jnd_error;
  return x;
}

}  // namespace

Defined<PopulationModel> population_model(const std::vector<AnsweredSeries>& series,
                                          const TrialsPlan& plan) {
  if (!plan.guess_free && plan.function.guess > 0.0) {
    return Undefined{
        "answers of a forced choice begin at the guess rate, which a probit line does "
        "not"};
  }
  const std::vector<std::string> conditions = conditions_of(series);
  if (conditions.empty() || conditions.size() > 2) {
    return Undefined{"it is for one condition or two"};
  }
  std::vector<Row> rows = rows_of(series, conditions, plan.function.axis);
  const std::size_t people = rows.empty() ? 0 : rows.back().participant + 1;
  if (people < kFewest) {
    return Undefined{"there are fewer than five participants"};
  }
  PopulationModel made;
  standardise(rows, made);
  if (!(made.scale > 0.0)) {
    return Undefined{"there is one level"};
  }
  const bool two = conditions.size() == 2;
  std::vector<std::size_t> participants, random{0, 1};
  for (const Row& row : rows) {
    participants.push_back(row.participant);
  }
  if (two) {
    random.insert(random.end(), {2, 3});
  }
  const auto fit =
      binomial_mixed_model(data_of(rows, two), BinomialLink::kProbit, participants, random);
  if (!fit) {
    return Undefined{fit.because()};
  }
  made.model = *fit;
  judge_by_participants(made);
  made.names = {"intercept", "level"};
  if (two) {
    made.names.insert(made.names.end(),
                      {conditions[1] + " less " + conditions[0], "level by condition"});
    const BinomialCoefficient& c = made.model.fixed.coefficients[2];
    made.condition_t = c.z;
    made.condition_df = degrees_of_freedom(made);
    made.condition_p = c.p;
  }
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    made.points.push_back({conditions[i], crossing(made, i == 0 ? -0.5 : 0.5)});
  }
  return made;
}

namespace {

constexpr std::size_t kFewestPeople = 3;  // participants

/// People and conditions by number. Answers come by person and condition.
std::vector<hierarchical::PersonAnswers> answers_of(const std::vector<AnsweredSeries>& series,
                                                    HierarchicalFunctions& made) {
  std::set<std::vector<std::string>> levels;
  for (const AnsweredSeries& each : series) {
    levels.insert(each.levels);
  }
  made.levels.assign(levels.begin(), levels.end());
  made.conditions.resize(made.levels.size());
  std::vector<hierarchical::PersonAnswers> answers;
  for (const AnsweredSeries& each : series) {
    if (made.participants.empty() || made.participants.back() != each.participant) {
      made.participants.push_back(each.participant);
    }
    const auto condition =
        static_cast<std::size_t>(std::ranges::find(made.levels, each.levels) - made.levels.begin());
    made.conditions[condition] = each.condition();
    answers.push_back({made.participants.size() - 1, condition, blocks_of(each)});
  }
  std::ranges::sort(answers, [](const auto& a, const auto& b) {
    return std::pair(a.person, a.condition) < std::pair(b.person, b.condition);
  });
  return answers;
}

}  // namespace

Defined<HierarchicalFunctions> hierarchical_functions(const std::vector<AnsweredSeries>& series,
                                                      const TrialsPlan& plan, int threads) {
  HierarchicalFunctions made;
  std::vector<hierarchical::PersonAnswers> answers = answers_of(series, made);
  if (made.participants.size() < kFewestPeople) {
    return Undefined{"there are fewer than three participants"};
  }
  for (const hierarchical::PersonAnswers& each : answers) {
    made.condition_of.push_back(each.condition);
  }
  LikelihoodOptions options = likelihood_options(plan);
  if (std::ranges::any_of(series, [](const auto& each) { return each.catches.total > 0; })) {
    options.guess.high = kLargestRate;
  }
  hierarchical::Sampling sampling;
  sampling.seed = plan.seed;
  sampling.threads = threads;
  try {
    made.fit = hierarchical_fit(hierarchical::Model(std::move(answers), options), sampling);
  } catch (const std::invalid_argument& error) {
    return Undefined{error.what()};
  }
  return made;
}

}  // namespace haptrial::analysis::trials
