#include "analysis/statistics/variance/anova.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::anova_reference {
namespace {

void compare_case(Answers& r, const char* name, const std::vector<std::vector<double>>& groups) {
  const auto a = one_way_anova(groups);
  r.at("One-way ANOVA", name)
      .is("f", a->f)
      .is("df_between", a->df_between)
      .is("df_within", a->df_within)
      .is("between", a->squares_between)
      .is("within", a->squares_within)
      .is("p", a->p);
}

void compare(Answers& r) {
  compare_case(r, "unequal", DataSet("unequal").groups("value", "group"));
  compare_case(r, "ties", DataSet("ties").groups("value", "group"));
  compare_case(r, "study", DataSet("study").groups("score", "condition"));
  compare_case(r, "offset", DataSet("offset").groups("value", "group"));
}

const Topic kTopic("anova", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::anova_reference
