#include "analysis/alignment/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::analysis {
namespace {

constexpr double kLargestPower = 100.0;

}  // namespace

const std::vector<std::string>& pattern_names() {
  static const std::vector<std::string> names{"published", "symmetric1", "symmetric2", "asymmetric",
                                              "symmetricP1"};
  return names;
}

std::string_view name_of(StepPattern pattern) {
  return pattern_names()[static_cast<std::size_t>(pattern)];
}

std::optional<StepPattern> pattern_of(std::string_view name) {
  const auto& names = pattern_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    return std::nullopt;
  }
  return static_cast<StepPattern>(at - names.begin());
}

bool doubles_straight(StepPattern pattern) {
  return pattern == StepPattern::kSymmetric2 || pattern == StepPattern::kSymmetricP1;
}

std::string problem_of(const AlignmentOptions& o) {
  const auto is_bounded = [](double x) { return x >= 0.0 && x <= kLargestAlignmentError; };
  const auto bad = [](const char* name, double found) {
    return fmt::format("{} is {}; allowed: a finite number of at least 0", name, found);
  };
  if (!is_bounded(o.force_weight)) {
    return bad("force_weight", o.force_weight);
  }
  if (!is_bounded(o.slope_weight)) {
    return bad("slope_weight", o.slope_weight);
  }
  if (!is_bounded(o.penalty)) {
    return bad("penalty", o.penalty);
  }
  if (!(o.power >= 1.0 && o.power <= kLargestPower)) {
    return fmt::format("power is {}; allowed: a number from 1 to {}", o.power, kLargestPower);
  }
  if (o.open_begin && doubles_straight(o.pattern)) {
    return fmt::format(
        "open_begin is true with the pattern {}, whose cost grows with the applied samples that "
        "are paired, so that leaving them out always looks cheaper; choose published, symmetric1, "
        "asymmetric",
        name_of(o.pattern));
  }
  return "";
}

bool is_vectorized(const AlignmentOptions& o) {
  const bool is_simple =
      o.pattern != StepPattern::kAsymmetric && o.pattern != StepPattern::kSymmetricP1;
  return is_simple && (o.power == 1.0 || o.power == 2.0) && !o.window && !o.open_begin &&
         !o.open_end;
}

}  // namespace haptrial::analysis
