#include "analysis/statistics/base/p_adjust.h"

#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::p_adjust_reference {
namespace {

using Values = std::vector<double>;

void compare_case(Answers& r, const char* name, const Values& p) {
  r.at("Holm", name).are("p", holm_adjusted(p));
}

void compare(Answers& r) {
  compare_case(r, "few", {0.04, 0.01, 0.03, 0.02});
  compare_case(r, "ties", {0.02, 0.02, 0.5, 0.001, 0.5, 1, 0});
  r.at("Holm", "one").is("p", holm_adjusted(Values{0.3})[0]);
  Values many;
  for (int i = 1; i <= 40; ++i) {
    const double x = (i * 17) % 41 / 41.0;
    many.push_back(x * x * x);
  }
  compare_case(r, "many", many);
}

const Topic kTopic("p_adjust", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::p_adjust_reference
