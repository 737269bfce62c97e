#include "analysis/psychophysics/fit/paired_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {

PairedPlan read_paired_plan(Table& table, const std::vector<std::string>& known) {
  using P = PairedPlan;
  const auto check = [&](Table& t, const char* key, const std::string& name) {
    if (!name.empty() && !known.empty() && std::ranges::find(known, name) == known.end()) {
      t.reject(key, fmt::format("\"{}\"", name),
               fmt::format("a factor or variable: {}", fmt::join(known, ", ")));
    }
  };
  return Schema<P>()
      .text("first", &P::first, "Factor or variable that names the item of the first interval")
      .required()
      .text("second", &P::second, "Factor or variable that names the item of the second interval")
      .required()
      .choice(
          "model", &P::model,
          {{"Bradley-Terry", PairedModel::kBradleyTerry}, {"Thurstone", PairedModel::kThurstone}},
          "Model of the choices: worths in log odds, or in standard deviations of a difference")
      .check([&](Table& t, P& plan) {
        check(t, "first", plan.first);
        check(t, "second", plan.second);
      })
      .read(table);
}

}  // namespace haptrial::analysis::trials
