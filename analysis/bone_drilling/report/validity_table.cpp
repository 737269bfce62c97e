#include "analysis/bone_drilling/report/validity_table.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace haptrial::analysis::drilling {
namespace {

using Values = std::vector<double>;

template <class Predicate>
Values values_where(const ValueTable& table, Predicate&& wanted) {
  Values values;
  for (const ValueTable::Row& row : table.rows) {
    if (row.value && wanted(row)) {
      values.push_back(*row.value);
    }
  }
  return values;
}

template <class Predicate>
GroupValues values_of_group(const ValueTable& table, const ValueTable& means, std::string name,
                            Predicate&& wanted) {
  GroupValues group{.group = std::move(name)};
  const Values pooled = values_where(table, wanted);
  const Values by_participant = values_where(means, wanted);
  group.procedures = pooled.size();
  group.participants = by_participant.size();
  group.pooled = mean_interval(pooled);
  group.participant_means = mean_interval(by_participant);
  if (const Defined<Moments> m = moments(by_participant)) {
    group.mean = m->mean();
  }
  return group;
}

// value ~ expert (+ number): the side in the first column.
Defined<MixedModel> mixed_model(const ValueTable& table) {
  Values values, numbers;
  std::vector<std::size_t> people;
  std::vector<double> side;
  for (const ValueTable::Row& row : table.rows) {
    if (row.value) {
      values.push_back(*row.value);
      numbers.push_back(row.number);
      people.push_back(row.participant);
      side.push_back(row.expert ? 1.0 : 0.0);
    }
  }
  if (values.empty()) {
    return Undefined{"there are no values"};
  }
  const auto rows = static_cast<Eigen::Index>(values.size());
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  Eigen::MatrixXd predictors(rows, *least < *most ? 2 : 1);
  predictors.col(0) = Eigen::VectorXd::Map(side.data(), rows);
  if (predictors.cols() == 2) {
    const Eigen::VectorXd all = Eigen::VectorXd::Map(numbers.data(), rows);
    predictors.col(1) = all.array() - all.mean();
  }
  return random_intercept_model(values, predictors, people);
}

double one_tailed(const Coefficient& c, Tail tail) {
  if (tail == Tail::kTwoSided) {
    return c.p;
  }
  const bool as_expected = (tail == Tail::kGreater) == (c.estimate > 0.0);
  return as_expected ? 0.5 * c.p : 1.0 - 0.5 * c.p;
}

}  // namespace

Tail tail_of(Expected experts) {
  return experts == Expected::kHigher  ? Tail::kGreater
         : experts == Expected::kLower ? Tail::kLess
                                       : Tail::kTwoSided;
}

ValueTable table_of(const Validity& v, std::span<const ProcedureSummary> procedures) {
  ValueTable table;
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    table.rows.push_back({std::nullopt, v.participant[i], procedures[i].group, v.expert[i],
                          static_cast<double>(procedures[i].number)});
  }
  return table;
}

ValueTable participant_means(const ValueTable& table) {
  std::map<std::size_t, ValueTable::Row> people;
  std::map<std::size_t, double> counts;
  for (const ValueTable::Row& row : table.rows) {
    ValueTable::Row& own =
        people
            .try_emplace(row.participant,
                         ValueTable::Row{std::nullopt, row.participant, row.group, row.expert, 1.0})
            .first->second;
    if (row.value) {
      own.value = own.value.value_or(0.0) + *row.value;
      counts[row.participant] += 1.0;
    }
  }
  ValueTable means;
  for (auto& [number, row] : people) {
    if (row.value) {
      *row.value /= counts[number];
    }
    means.rows.push_back(std::move(row));
  }
  return means;
}

std::pair<Values, Values> paired(const ValueTable& a, const ValueTable& b) {
  if (a.rows.size() != b.rows.size()) {
    throw std::invalid_argument("paired: the tables have different lengths");
  }
  std::pair<Values, Values> both;
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    if (a.rows[i].value && b.rows[i].value) {
      both.first.push_back(*a.rows[i].value);
      both.second.push_back(*b.rows[i].value);
    }
  }
  return both;
}

std::vector<GroupValues> group_values(const ValueTable& table, const ValidityPlan& plan) {
  const ValueTable means = participant_means(table);
  std::vector<GroupValues> groups;
  for (const std::string& name : plan.groups) {
    groups.push_back(
        values_of_group(table, means, name, [&](const auto& row) { return row.group == name; }));
  }
  groups.push_back(
      values_of_group(table, means, "all experts", [](const auto& row) { return row.expert; }));
  groups.push_back(
      values_of_group(table, means, "all novices", [](const auto& row) { return !row.expert; }));
  return groups;
}

Contrast contrast(const ValueTable& table, Expected experts) {
  const Tail tail = tail_of(experts);
  const ValueTable means = participant_means(table);
  const auto expert = [](const auto& row) { return row.expert; };
  const auto novice = [](const auto& row) { return !row.expert; };
  Contrast c;
  c.pooled = student_t_test(values_where(table, expert), values_where(table, novice), tail);
  const Values expert_means = values_where(means, expert);
  const Values novice_means = values_where(means, novice);
  c.means = welch_t_test(expert_means, novice_means, tail);
  c.g = hedges_g(expert_means, novice_means);
  c.mixed = mixed_model(table);
  c.mixed_p = c.mixed ? Defined<double>(one_tailed(c.mixed->coefficients[1], tail))
                      : Undefined{c.mixed.because()};
  std::vector<RocCase> cases;
  for (const ValueTable::Row& row : table.rows) {
    if (row.value) {
      cases.push_back(
          {experts == Expected::kLower ? -*row.value : *row.value, row.expert, row.participant});
    }
  }
  c.roc = roc(cases);
  return c;
}

}  // namespace haptrial::analysis::drilling
