#include "experiments/runner/trial_presenter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"

namespace haptrial::experiments {

using protocols::AfterAbort;
using protocols::Outcome;
using protocols::PlannedTrial;
using protocols::TrialEnd;

TrialPresenter::TrialPresenter(const Parts& parts)
    : p_(parts),
      aborted_({parts.definition, parts.trials, parts.record, parts.controller, parts.pacing,
                parts.notices, parts.real}) {}

Outcome TrialPresenter::present(const PlannedTrial& trial) {
  const auto begun = std::chrono::steady_clock::now();
  p_.controller.requests().skip = false;
  p_.trials.prepare(trial, p_.record);  // may take seconds, in which somebody may ask for something
  p_.notices.note(p_.trials.take_warnings());
  p_.prepared();
  responses_.clear();
  AttemptResult last;
  while (!p_.controller.requests().abort && !p_.last_answer.goes_back() && last.again) {
    last = present_once(trial);
  }
  const bool completed = last.end == TrialEnd::kCompleted;
  p_.last_answer.end_trial(completed);
  if (completed && !trial.practice) {
    note_time_left(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  }
  return {trial, last.end, responses_};
}

TrialPresenter::AttemptResult TrialPresenter::present_once(const PlannedTrial& trial) {
  PendingRequests& requests = p_.controller.requests();
  const int attempt = p_.last_answer.begin_attempt(trial);
  const bool anew = std::exchange(requests.repeat, false);
  responses_.clear();
  p_.trials.begin_attempt(trial, anew);
  show();
  p_.record.mark_trial("trial_begin", trial, attempt);
  const bool presented = run_passes(trial, attempt);
  p_.pacing.pause_where_asked();
  const bool done = answer_stands(presented);
  const AfterAbort after = done ? AfterAbort::kAsAsked : p_.trials.after_abort();
  // One whose answer before is taken back follows from that answer, and is presented after it.
  const bool skipped =
      (requests.skip || after == AfterAbort::kSkip) && !done && !p_.last_answer.goes_back();
  const char* how = done ? "completed" : skipped ? "skipped" : "aborted";
  p_.record.mark_trial("trial_end", trial, attempt, how);
  p_.notices.say_trial(trial, how);
  if (skipped) {
    p_.record.skip(trial);
  }
  const bool over = (done && !requests.repeat) || requests.skip || skipped;
  const bool wanted =
      (p_.controller.attended() && !p_.last_answer.goes_back()) || after == AfterAbort::kAgain;
  return {done      ? TrialEnd::kCompleted
          : skipped ? TrialEnd::kSkipped
                    : TrialEnd::kAborted,
          wanted && !over};
}

/// Sees to what was asked for during an attempt. @returns whether it was presented, and nobody took
/// its answer back or wants it anew
bool TrialPresenter::answer_stands(bool presented) {
  PendingRequests& requests = p_.controller.requests();
  p_.last_answer.see_to_request();
  if (presented && requests.repeat && p_.last_answer.next() == LastAnswer::Next::kAsPlanned) {
    p_.last_answer.repeat();
  }
  requests.repeat = requests.repeat || p_.last_answer.next() == LastAnswer::Next::kSameTrial;
  return presented && p_.last_answer.next() == LastAnswer::Next::kAsPlanned;
}

void TrialPresenter::show() {
  p_.pacing.clear_text();
  if (p_.screen != nullptr) {
    const std::uint64_t number = p_.screen->show(p_.trials.drawing());
    p_.pacing.clear_text();
    if (p_.trials.waits_for_picture()) {
      p_.pacing.wait_for_picture(number);
    }
    p_.prepared();
  }
}

/// @returns whether all passes were completed.
bool TrialPresenter::run_passes(const PlannedTrial& trial, int attempt) {
  bool done = true;
  const std::span<const record::Phase> phases = p_.trials.phases();
  for (std::size_t i = 0; i < phases.size(); ++i) {
    p_.pacing.pause_where_asked();
    const PendingRequests& requests = p_.controller.requests();
    if (requests.repeat || requests.skip || requests.abort ||
        p_.last_answer.next() != LastAnswer::Next::kAsPlanned) {
      return false;
    }
    const bool completed = run_pass(trial, phases[i], attempt);
    if (!completed &&
        (p_.controller.attended() || p_.trials.after_abort() != AfterAbort::kAsAsked)) {
      return false;  // the trial is presented again, from its first pass on
    }
    done = done && completed;
  }
  return done;
}

bool TrialPresenter::run_pass(const PlannedTrial& trial, const record::Phase& phase, int attempt) {
  if (p_.pacing.text_shown()) {
    show();
  }
  PlannedTrial row = trial;
  protocols::Pass& pass = p_.trials.make_pass(row, phase);
  p_.record.markers().prepare(p_.trials.varied_cues());
  const std::int32_t number = p_.record.begin_pass(row, phase, attempt);
  p_.task.start(pass, number);
  p_.last_answer.add_pass(number);
  ++p_.summary.passes;
  p_.pacing.drive_until_idle();
  p_.notices.note_overruns(p_.pacing.watch());
  const protocols::PassResult& result = p_.task.result();
  const bool aborted = result.state == protocols::PassState::kAborted;
  p_.trials.close_pass(p_.record, number);
  keep_responses();
  p_.record.end_pass(result);
  if (p_.record.markers().lost_stimuli()) {
    throw RunError(
        "the sound card was lost, which gives the stimuli; see to it, and go on with --resume");
  }
  p_.notices.note_pass(result);
  if (aborted) {
    p_.controller.status().aborted_passes = ++p_.summary.aborted_passes;
    aborted_.see_to(result);
  } else {
    aborted_.note_completed();
  }
  p_.trials.draw_pictures(trial, phase);
  return !aborted;
}

void TrialPresenter::keep_responses() {
  std::vector<record::ResponseRow> rows = p_.trials.responses();
  std::optional<std::int64_t> answered;
  if (!rows.empty()) {
    answered = p_.record.time_of(rows.front().sequence) - p_.record.session_time(0);
  }
  p_.mistakes.close_pass(p_.record.pass(), answered);
  if (!rows.empty()) {
    p_.last_answer.note_answer();
    responses_.insert(responses_.end(), rows.begin(), rows.end());
    p_.record.keep_responses(std::move(rows));
  }
}

/// Trials to come are taken to last as long, in the mean, as those of this run.
void TrialPresenter::note_time_left(double trial_seconds) {
  seconds_ += trial_seconds;
  ++timed_;
  SessionStatus& status = p_.controller.status();
  const protocols::Design& design = p_.definition.design;
  const int trials = std::max(0, status.trials - status.trial);
  const int breaks = design.break_after > 0 ? trials / design.break_after : 0;
  status.left = trials * seconds_ / timed_ + breaks * design.break_duration;
}

void AbortedPass::see_to(const protocols::PassResult& result) {
  const bool fault = result.fault != device::Fault::kNone;
  const std::string why = fault ? cause(result) : why_broken_off();
  const std::string trouble = result.trouble;
  const std::string all = trouble.empty() ? why : why + "; " + trouble;
  const bool asked = asked_for();
  const bool overloaded = !p_.pacing.overload().empty();  // and no better the next time
  p_.record.event("aborted", fmt::format("trial {}: {}", p_.record.pass().trial, all));
  note_abort(all);
  if (result.fault == device::Fault::kStopButton) {
    p_.record.event("emergency_stop", "by the handle");
  }
  if ((fault || overloaded) && p_.controller.attended()) {
    p_.controller.status().fault = all;
    p_.controller.requests().stopped = true;  // a person sees to the cause
    p_.notices.say_stopped(p_.record.pass().trial, all);
  } else if (result.fault == device::Fault::kEmergencyStop && p_.real && partner_stops()) {
    p_.pacing.recover_when([this] { return !partner_stops(); });  // who stopped sees to the cause
  } else if ((fault || overloaded) && p_.real) {
    // Nobody is at a console or keyboard to see to the cause and say that it may go on.
    p_.pacing.let_read(p_.definition.texts.stopped, "stopped");
    p_.pacing.end_early(all);
  } else {
    p_.pacing.recover();
    pause_after_several(all, asked);
  }
}

/// Notes an abort for the console, which shows the last ones.
void AbortedPass::note_abort(const std::string& why) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string>& aborts = p_.controller.status().aborts;
  aborts.push_back(fmt::format("trial {}: {}", p_.record.pass().trial, why));
  if (aborts.size() > kShown) {
    aborts.erase(aborts.begin());
  }
}

void AbortedPass::pause_after_several(const std::string& why, bool asked) {
  constexpr int kMost = 3;
  if (asked) {
    return;
  }
  if (++in_row_ >= kMost && p_.real) {
    in_row_ = 0;
    p_.notices.note(fmt::format("paused after {} aborts in a row: {}", kMost, why));
    p_.pacing.wait_to_begin(p_.definition.texts.paused);
  }
}

/// Whether this experimenter, or the partner's, asked for the abort.
bool AbortedPass::asked_for() const {
  const PendingRequests& requests = p_.controller.requests();
  return requests.repeat || requests.skip || requests.abort || requests.pause ||
         requests.take_back || p_.trials.after_abort() != protocols::AfterAbort::kAsAsked;
}

bool AbortedPass::partner_stops() const {
  const auto partner = p_.trials.partner();
  return partner && partner->stops;
}

/// The fault, with the name of the device that it is of; a stop or a channel is of none.
std::string AbortedPass::cause(const protocols::PassResult& result) const {
  using device::Fault;
  const std::string fault = device::describe(result.fault);
  const std::vector<protocols::DeviceArm> arms = p_.definition.arms();
  if (arms.size() < 2 || result.fault == Fault::kEmergencyStop ||
      result.fault == Fault::kChannelLost || result.fault == Fault::kBeyondLimit) {
    return fault;
  }
  const std::string& name = arms[result.device].name;
  return fmt::format("{}: {}",
                     !name.empty()        ? name
                     : result.device == 0 ? "first device"
                                          : "second device",
                     fault);
}

std::string AbortedPass::why_broken_off() const {
  const PendingRequests& requests = p_.controller.requests();
  if (!p_.pacing.overload().empty()) {
    return p_.pacing.overload();
  }
  if (requests.repeat) {
    return "to be repeated";
  }
  if (requests.take_back) {
    return "an answer was taken back";
  }
  if (requests.skip) {
    return "skipped";
  }
  if (requests.abort) {
    return requests.for_good ? "the session was ended for good" : "the session was stopped";
  }
  return p_.trials.why_aborted();
}

}  // namespace haptrial::experiments
