#include "analysis/psychophysics/study/magnitudes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/psychophysics/fit/series.h"

namespace haptrial::analysis::trials {
namespace {

/// The number that was given, or measured; NaN: none.
double given(const StudyTrial& trial, const std::string& question) {
  const GivenAnswer* answer = answer_to(trial, question);
  return answer == nullptr ? kNotKnown : answer->value;
}

std::size_t number_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) {
    return static_cast<std::size_t>(at - names.begin());
  }
  names.push_back(name);
  return names.size() - 1;
}

/// One level has no slope; the others keep their exponents.
void leave_out_one_level(MagnitudeCondition& one) {
  std::map<std::size_t, std::set<double>> levels;
  for (const MagnitudeTrial& trial : one.trials) {
    levels[trial.participant].insert(trial.level);
  }
  for (const auto& [participant, own] : levels) {
    if (own.size() < 2) {
      one.one_level.push_back(one.participants[participant]);
    }
  }
  std::erase_if(one.trials, [&](const MagnitudeTrial& trial) {
    return levels.at(trial.participant).size() < 2;
  });
}

Defined<PowerLaw> law_of(const MagnitudeCondition& one) {
  if (one.trials.empty()) {
    return Undefined{one.one_level.empty() ? "no answer is above 0"
                                           : "nobody has answers at several levels"};
  }
  return power_law(one.trials);
}

}  // namespace

std::vector<MagnitudeCondition> magnitudes(const TrialsData& data, const TrialsPlan& plan) {
  std::map<std::vector<std::string>, MagnitudeCondition> all;
  for (const StudyTrial& trial : data.trials) {
    const double level = level_of(trial, plan);
    const double value = given(trial, plan.question);
    if (!trial.counts() || !trial.probe.empty() || !std::isfinite(level) || !std::isfinite(value)) {
      continue;
    }
    MagnitudeCondition& own = all[factors_of(data, trial, plan)];
    const double measured = plan.measured.empty() ? kNotKnown : given(trial, plan.measured);
    const bool known = plan.measured.empty() || measured > 0.0;
    if (level > 0.0 && value > 0.0 && known) {
      own.trials.push_back({number_of(own.participants, data.session_of(trial).participant), level,
                            value, measured});
    } else {
      ++own.not_positive;
    }
  }
  std::vector<MagnitudeCondition> result;
  for (auto& [levels, own] : all) {
    leave_out_one_level(own);
    own.levels = levels;
    own.condition = fmt::format("{}", fmt::join(levels, ", "));
    own.law = law_of(own);
    result.push_back(std::move(own));
  }
  return result;
}

}  // namespace haptrial::analysis::trials
