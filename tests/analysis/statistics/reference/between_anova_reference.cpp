#include <set>

#include "analysis/statistics/variance/anova.h"
#include "tests/analysis/statistics/reference/reference.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis::reference::between_anova_reference {
namespace {

void compare_welch(Answers& r, const char* name) {
  const auto a = welch_anova(DataSet(name).groups("value", "group"));
  r.at("Welch's ANOVA", name)
      .is("f", a->f)
      .is("df_between", a->df_between)
      .is("df_within", a->df_within)
      .is("p", a->p);
}

/// The group by whether the row's number is a multiple of three: cells of different size.
void compare_two_way(Answers& r, const std::string& name) {
  const DataSet data(name);
  const auto values = data.numbers("value");
  const auto& groups = data.texts("group");
  const std::set<std::string> levels(groups.begin(), groups.end());
  std::vector<std::vector<double>> cells(2 * levels.size());
  for (std::size_t row = 0; row < values.size(); ++row) {
    const auto a =
        static_cast<std::size_t>(std::distance(levels.begin(), levels.find(groups[row])));
    cells[2 * a + ((row + 1) % 3 == 0 ? 1 : 0)].push_back(values[row]);
  }
  const auto found = test::two_between(cells, levels.size());
  for (const auto& [effect, test] :
       {std::pair{"a", &found.a}, std::pair{"b", &found.b}, std::pair{"a:b", &found.interaction}}) {
    r.at("Two-way ANOVA type III", name + " " + effect)
        .is("f", (*test)->f)
        .is("df", (*test)->df)
        .is("squares", (*test)->squares)
        .is("p", (*test)->p);
  }
}

void compare(Answers& r) {
  for (const char* name : {"unequal", "ties"}) {
    compare_welch(r, name);
  }
  for (const char* name : {"unequal", "ties"}) {
    compare_two_way(r, name);
  }
}

const Topic kTopic("between_anova", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::between_anova_reference
