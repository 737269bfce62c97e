#include "experiments/power/power_strains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/studies/rehearsal/power_plan.h"

namespace haptrial::experiments {
namespace {

/// Whether one of two keys is the other, or a part of it.
bool meet(std::string_view a, std::string_view b) {
  const std::size_t shorter = std::min(a.size(), b.size());
  return a.substr(0, shorter) == b.substr(0, shorter) &&
         (a.size() == b.size() || (a.size() > shorter ? a : b)[shorter] == '.');
}

std::string refusal_of(const QuestionStrain& strain, const PowerPlan& plan) {
  for (const GivenKey& given : strain.keys) {
    for (const VariedKey& varied : plan.vary) {
      if (meet(given.key, varied.key)) {
        return fmt::format("the question itself varies {}", varied.key);
      }
    }
  }
  return "";
}

}  // namespace

std::vector<QuestionStrain> strains_of(const Rehearsal& rehearsal, const PowerPlan& plan) {
  std::vector<QuestionStrain> strains{{"one participant lost", {}, 1.0, ""},
                                      {"one participant in ten lost", {}, 0.1, ""}};
  for (Strain& each : rehearsal.strains()) {
    QuestionStrain strain{std::move(each.name), std::move(each.keys), 0.0, ""};
    strain.refused = refusal_of(strain, plan);
    strains.push_back(std::move(strain));
  }
  return strains;
}

std::vector<GivenKey> keys_under(const QuestionStrain& strain, long participants) {
  std::vector<GivenKey> keys = strain.keys;
  if (strain.lost > 0.0) {
    const double share = strain.lost < 1.0 ? static_cast<double>(participants) : 1.0;
    const long lost = std::lround(std::ceil(strain.lost * share - 1e-9));
    keys.push_back({"design.participants", std::to_string(participants - lost)});
  }
  return keys;
}

}  // namespace haptrial::experiments
