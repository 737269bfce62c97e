#include "experiments/runner/last_answer.h"

#include <fmt/format.h>

#include <utility>

#include "experiments/runner/earlier_run.h"

namespace haptrial::experiments {

using protocols::PlannedTrial;

int LastAnswer::begin_attempt(const PlannedTrial& trial) {
  if (now_.trial != trial.trial || now_.practice != trial.practice) {
    now_ = {trial.trial, trial.practice, {}, false};
  }
  now_.answered = false;
  next_ = Next::kAsPlanned;
  show();
  const auto [known, is_new] = attempts_.try_emplace({trial.trial, trial.practice, trial.condition},
                                                     attempts_of(p_.record.earlier(), trial));
  return ++known->second;
}

void LastAnswer::note_answer() {
  now_.answered = true;
  show();
}

void LastAnswer::end_trial(bool completed) {
  const Attempt over = std::exchange(now_, {});
  before_.reset();
  if (completed && over.answered && p_.trials.can_take_back()) {
    before_ = over;
  }
  show();
}

void LastAnswer::forget() {
  now_ = {};
  before_.reset();
  show();
}

void LastAnswer::see_to_request() {
  auto& request = p_.controller.requests().take_back;
  if (!request || p_.record.in_pass()) {
    return;
  }
  const std::string by = name_of(*std::exchange(request, std::nullopt));
  if (!now_.answered && !before_) {
    return;
  }
  next_ = now_.answered ? Next::kSameTrial : Next::kTrialBefore;
  if (next_ == Next::kTrialBefore) {  // the present trial follows from that answer
    p_.record.take_back(now_.trial, now_.passes);
  }
  record(now_.answered ? now_ : *before_, "by the " + by);
  forget();
}

void LastAnswer::repeat() {
  next_ = Next::kSameTrial;
  record(now_, "repeated after its end");
  forget();
}

void LastAnswer::record(const Attempt& attempt, const std::string& why) {
  p_.record.take_back(attempt.trial, attempt.passes);
  p_.record.event(
      "taken_back",
      fmt::format("{} {}: {}", attempt.practice ? "practice trial" : "trial", attempt.trial, why));
}

std::optional<PlannedTrial> LastAnswer::go_back() {
  next_ = Next::kAsPlanned;
  return p_.trials.take_back();
}

void LastAnswer::show() {
  p_.controller.status().can_take_back = now_.answered || before_.has_value();
}

}  // namespace haptrial::experiments
