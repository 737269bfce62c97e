#include "analysis/statistics/variance/repeated_anova.h"

#include "tests/analysis/statistics/reference/reference.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis::reference::repeated_anova_reference {
namespace {

using Table = std::vector<std::vector<double>>;

constexpr const char* kOneFactor = "Repeated-measures ANOVA: one factor";
constexpr const char* kTwoFactors = "Repeated-measures ANOVA: two factors";
constexpr double kOffset = 1e12;  // exact for values that are multiples of 1/64

Table shifted(Table table) {
  for (auto& row : table) {
    for (auto& value : row) {
      value += kOffset;
    }
  }
  return table;
}

void compare_tests(Answers::Case at, const WithinEffect& e) {
  at.is("f", e.f).is("df", e.df).is("df_error", e.df_error).is("p", e.p);
  if (e.df > 1.0) {
    const Sphericity& s = e.sphericity;
    at.is("p_gg", e.p_greenhouse_geisser).is("p_hf", *e.p_huynh_feldt);
    at.is("gg", s.greenhouse_geisser).is("hf", *s.huynh_feldt);
    at.is("w", s.mauchly->w).is("p_w", s.mauchly->p);
  }
}

void compare_squares(Answers::Case at, const WithinEffect& e) {
  at.is("squares", e.squares).is("squares_error", e.squares_error);
}

void compare_one(Answers& r, const std::string& name, const Table& table) {
  const auto a = repeated_measures_anova(table);
  r.at(kOneFactor, name + " condition")
      .is("f", a->f)
      .is("df", a->df_condition)
      .is("df_error", a->df_error)
      .is("p", a->p)
      .is("p_gg", a->p_corrected)
      .is("p_hf", *a->p_huynh_feldt)
      .is("gg", a->epsilon)
      .is("hf", *a->sphericity.huynh_feldt)
      .is("w", a->sphericity.mauchly->w)
      .is("p_w", a->sphericity.mauchly->p)
      .is("squares", a->squares_condition)
      .is("squares_error", a->squares_error);
  r.at(kOneFactor, name).is("participants", a->squares_participants);
}

void compare_two(Answers& r, const std::string& name, const Table& table, std::size_t levels_a) {
  const auto a = test::two_within(table, levels_a);
  for (const auto& [effect, found] :
       {std::pair{" a", a.a}, std::pair{" b", a.b}, std::pair{" a:b", a.interaction}}) {
    compare_tests(r.at(kTwoFactors, name + effect), *found);
    compare_squares(r.at(kTwoFactors, name + effect), *found);
  }
}

// (participants x conditions * repetitions): means of eight blocks, still exact behind an offset.
Table by_condition_and_repetition(const DataSet& study, bool without_last) {
  const auto scores = study.numbers("score");
  const auto& subjects = study.texts("subject");
  const auto& conditions = study.texts("condition");
  const auto& repetitions = study.texts("repetition");
  std::map<std::string, std::map<std::string, double>> cells;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (!(without_last && repetitions[i] == "r3")) {
      cells[subjects[i]][conditions[i] + repetitions[i]] += scores[i] / 8.0;
    }
  }
  Table table;
  for (const auto& [subject, row] : cells) {
    table.emplace_back();
    for (const auto& [cell, mean] : row) {
      table.back().push_back(mean);
    }
  }
  return table;
}

void compare_repeated(Answers& r) {
  const DataSet study("study");
  const Table times = DataSet("times").means("value", "subject", "condition");
  const Table five(times.begin(), times.begin() + 5);
  compare_one(r, "study", study.means("score", "subject", "condition"));
  for (const auto& move : {+[](Table t) { return t; }, +[](Table t) { return shifted(t); }}) {
    compare_one(r, "times", move(times));
    compare_one(r, "times of five", move(five));
    compare_two(r, "study", move(by_condition_and_repetition(study, false)), 3);
    compare_two(r, "two repetitions", move(by_condition_and_repetition(study, true)), 3);
  }
}

const Topic kRepeated("repeated_anova", compare_repeated);

// Tables of the groups, in order of their names.
std::vector<Table> by_group(const DataSet& data, const char* value) {
  const Table table = data.means(value, "subject", "condition");
  std::map<std::string, std::string> group_of;
  for (std::size_t i = 0; i < data.texts("subject").size(); ++i) {
    group_of[data.texts("subject")[i]] = data.texts("group")[i];
  }
  std::map<std::string, Table> groups;
  std::size_t row = 0;
  for (const auto& [subject, group] : group_of) {
    groups[group].push_back(table[row++]);
  }
  std::vector<Table> result;
  for (const auto& [group, rows] : groups) {
    result.push_back(rows);
  }
  return result;
}

void compare_design(Answers& r, const char* name, const std::vector<Table>& groups) {
  const auto found = test::mixed_factors(groups);
  const WithinEffect& group = *found.a;
  r.at("Mixed ANOVA: group", name)
      .is("f", group.f)
      .is("df", group.df)
      .is("df_error", group.df_error)
      .is("squares", group.squares)
      .is("squares_error", group.squares_error)
      .is("p", group.p);
  const auto interaction = r.at("Mixed ANOVA: interaction", name);
  compare_tests(interaction, *found.interaction);
  compare_squares(interaction, *found.interaction);
  const WithinEffect& condition = *found.b;
  r.at("Mixed ANOVA: condition", name)
      .is("f", condition.f)
      .is("df", condition.df)
      .is("df_error", condition.df_error)
      .is("p", condition.p)
      .is("p_gg", condition.p_greenhouse_geisser)
      .is("p_hf", *condition.p_huynh_feldt);
}

void compare_mixed(Answers& r) {
  compare_design(r, "study", by_group(DataSet("study"), "score"));
  auto times = by_group(DataSet("times"), "value");
  compare_design(r, "times", times);
  for (auto& group : times) {
    group = shifted(group);
  }
  compare_design(r, "times", times);
}

const Topic kMixed("mixed_anova", compare_mixed);

}  // namespace
}  // namespace haptrial::analysis::reference::repeated_anova_reference
