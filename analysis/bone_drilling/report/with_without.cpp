#include "analysis/bone_drilling/report/with_without.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "analysis/statistics/design/wording.h"
#include "core/base/definition/given_in.h"

namespace haptrial::analysis::drilling {
namespace {

struct Mean {
  double sum{0.0};
  int count{0};
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return sum / count; }
};

}  // namespace

GivenProcedure given_procedure(const ProcedureSummary& summary, const std::string& condition,
                               std::string_view what) {
  return {summary.session,
          summary.participant,
          summary.group,
          condition,
          summary.number,
          summary.simulated,
          !says_off(condition, what),
          summary.usage.drilling};
}

WithWithout with_less_without(const std::vector<GivenValue>& values) {
  std::map<std::string, std::pair<Mean, Mean>> people;  // with, without
  for (const GivenValue& each : values) {
    if (each.value) {
      auto& [with, without] = people[each.participant];
      (each.given ? with : without).add(*each.value);
    }
  }
  std::vector<double> on, off;
  for (const auto& [participant, means] : people) {
    if (means.first.count > 0 && means.second.count > 0) {
      on.push_back(means.first.value());
      off.push_back(means.second.value());
    }
  }
  return {on.size(), paired_t_test(on, off, Tail::kTwoSided)};
}

FindingRow difference_findings(const std::string& name, const std::string& title,
                               const std::string& unit, const WithWithout& c) {
  Finding difference{.name = name + "/difference",
                     .title = title + ", with less without",
                     .unit = unit,
                     .n = c.participants,
                     .form = JsonForm::kEstimate};
  Finding p = plain_finding(name + "/p", title + ": p of the paired t-test", {});
  if (c.test) {
    difference.value = c.test->difference;
    difference.low = c.test->low;
    difference.high = c.test->high;
    p.value = c.test->p;
  } else {
    difference.why_not = p.why_not = c.test.because();
  }
  return {difference, p};
}

std::string difference_word(const WithWithout& c, const char* unit) {
  return c.test ? fmt::format("{:+.2f}{}{}, 95 % CI {:.2f} to {:.2f}, paired {} ({} participants)",
                              c.test->difference, *unit != '\0' ? " " : "", unit, c.test->low,
                              c.test->high, t_result(c.test), c.participants)
                : "not defined: " + c.test.because();
}

bool has_both(const std::vector<GivenValue>& values) {
  const auto given = [](const GivenValue& each) { return each.given; };
  return std::any_of(values.begin(), values.end(), given) &&
         !std::all_of(values.begin(), values.end(), given);
}

}  // namespace haptrial::analysis::drilling
