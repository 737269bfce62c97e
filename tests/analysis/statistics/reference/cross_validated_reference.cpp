#include <map>

#include "analysis/statistics/relation/cross_validated.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::cross_validated_reference {
namespace {

void compare(Answers& r) {
  const DataSet study("study");
  const auto trial = study.numbers("trial"), block = study.numbers("block");
  const auto& condition = study.texts("condition");
  const auto& group = study.texts("group");
  Eigen::MatrixXd x(static_cast<Eigen::Index>(trial.size()), 6);
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> who;
  for (std::size_t i = 0; i < trial.size(); ++i) {
    x.row(static_cast<Eigen::Index>(i)) << trial[i], trial[i] * trial[i],
        condition[i] == "visual" ? 1.0 : 0.0, condition[i] == "visuohaptic" ? 1.0 : 0.0,
        group[i] == "novice" ? 1.0 : 0.0, block[i];
    who.push_back(numbers.try_emplace(study.texts("subject")[i], numbers.size()).first->second);
  }
  const auto c = cross_validated_ridge(study.numbers("score"), x, who);
  r.at("Cross-validated ridge regression", "study")
      .is("lambda", c->lambda)
      .are("lambdas", c->lambdas)
      .are("slopes", {c->fit.slopes.begin(), c->fit.slopes.end()})
      .is("r", *c->validated.r)
      .is("rmse", c->validated.rmse)
      .is("r_resubstitution", *c->resubstitution.r)
      .is("rmse_resubstitution", c->resubstitution.rmse)
      .is("gain", c->gain);
}

const Topic kTopic("cross_validated", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::cross_validated_reference
