#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/tests/shapiro_wilk.h"
#include "analysis/statistics/variance/anova.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::checks_reference {
namespace {

using Values = std::vector<double>;
using Table = std::vector<Values>;

constexpr double kOffset = 1e12;  // exact: the values are multiples of 1/128 or more

Values shifted(Values values) {
  for (double& value : values) {
    value += kOffset;
  }
  return values;
}

void compare_levene(Answers& r, const char* name, Table groups) {
  for (const bool offset : {false, true}) {
    for (auto& group : groups) {
      group = offset ? shifted(group) : group;
    }
    for (const auto& [procedure, centre] :
         {std::pair{"Levene", Centre::kMean}, std::pair{"Brown-Forsythe", Centre::kMedian}}) {
      const auto a = levene(groups, centre);
      r.at(procedure, name)
          .is("f", a->f)
          .is("df_between", a->df_between)
          .is("df_within", a->df_within)
          .is("p", a->p);
    }
  }
}

void compare_shapiro(Answers& r, const std::string& name, const Values& values) {
  const auto s = shapiro_wilk(values);
  r.at("Shapiro-Wilk", name).is("w", s->w).is("p", s->p);
}

void compare_both(Answers& r, const std::string& name, const Values& values) {
  compare_shapiro(r, name, values);
  compare_shapiro(r, name, shifted(values));
}

Values residuals(const DataSet& study) {
  const auto& conditions = study.texts("condition");
  Values values = study.numbers("score");
  std::map<std::string, Values> groups;
  for (std::size_t i = 0; i < values.size(); ++i) {
    groups[conditions[i]].push_back(values[i]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] -= moments(groups[conditions[i]])->mean();
  }
  return values;
}

void compare(Answers& r) {
  const DataSet study("study");
  compare_levene(r, "unequal", DataSet("unequal").groups("value", "group"));
  compare_levene(r, "ties", DataSet("ties").groups("value", "group"));
  compare_levene(r, "study", study.groups("score", "condition"));

  const Values scores = study.numbers("score");
  for (const int n : {3, 4, 5, 6, 7, 10, 11, 12, 13, 28, 864}) {
    compare_both(r, "first " + std::to_string(n), Values(scores.begin(), scores.begin() + n));
  }
  compare_both(r, "ties", DataSet("ties").numbers("value"));
  compare_shapiro(r, "residuals", residuals(study));
  Values many;
  for (long i = 1; i <= 5000; ++i) {
    many.push_back(
        static_cast<double>((i * 7919) % 5003 + (i * 104729) % 5009 + (i * 1299709) % 5011) / 64.0);
  }
  compare_both(r, "5000", many);
  compare_both(r, "one far away", {1, 2, 3, 5, 4, 1000});
  compare_both(r, "ten equal", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1000});
}

const Topic kTopic("checks", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::checks_reference
