#include "analysis/statistics/relation/roc.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::roc_reference {
namespace {

using Values = std::vector<double>;

void compare_case(Answers& r, const std::string& name, const Values& positive,
                  const Values& negative) {
  const auto curve = roc(positive, negative);
  const auto wide = roc(positive, negative, 0.99);
  r.at("Area under a ROC curve", name)
      .is("area", curve->area)
      .is("error", curve->interval->error)
      .is("low", curve->interval->low)
      .is("high", curve->interval->high)
      .is("low_99", wide->interval->low)
      .is("high_99", wide->interval->high);
}

void compare(Answers& r) {
  const auto study = DataSet("study").groups("score", "group");
  compare_case(r, "study", study[1], study[0]);
  const auto unequal = DataSet("unequal").groups("value", "group");
  compare_case(r, "unequal", unequal[3], unequal[0]);
  const auto ties = DataSet("ties").groups("value", "group");
  compare_case(r, "ties", ties[2], ties[0]);
  compare_case(r, "ties below", ties[0], ties[2]);
}

const Topic kTopic("roc", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::roc_reference
