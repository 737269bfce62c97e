#include "experiments/runner/session_notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/short_numbers.h"

namespace haptrial::experiments {

using protocols::PlannedTrial;
using realtime::ClockKind;

namespace {

/// "practice, trial 3, test"
std::string words_of(const record::PassRow& pass) {
  return fmt::format("{}trial {}, {}", pass.practice ? "practice, " : "", pass.trial,
                     record::name_of(pass.phase));
}

}  // namespace

std::string planned_of(const protocols::Extent& extent, int defined) {
  return fmt::format(
      "{} of {} trials planned{}", extent.trials, defined,
      extent.practice > 0 ? fmt::format(", and {} for practice", extent.practice) : "");
}

void SessionNotices::tell(const std::string& line) const {
  if (p_.request.tell) {
    p_.request.tell(line);
  }
}

void SessionNotices::note(const std::string& notice) {
  auto& noted = p_.summary.notices;
  if (notice.empty() || std::find(noted.begin(), noted.end(), notice) != noted.end()) {
    return;
  }
  noted.push_back(notice);
  p_.controller.status().notices = noted;
  p_.record.event("notice", notice);
  tell("notice: " + notice);
}

void SessionNotices::note(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices) {
    note(notice);
  }
}

void SessionNotices::note_real_time() {
  if (p_.loop.clock() != ClockKind::kReal) {
    return;
  }
  constexpr std::chrono::seconds kLongest{2};  // locking memory takes its time
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (!p_.loop.started() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (p_.loop.started()) {
    note(p_.loop.real_time_status().notice);
  }
}

void SessionNotices::note_overruns(const LoopWatch& watch) {
  if (p_.loop.clock() != ClockKind::kReal) {
    return;
  }
  if (const auto late = watch.end_pass(p_.loop.ticks(), p_.loop.overruns())) {
    const std::string what = fmt::format("{}: {}", words_of(p_.record.pass()), *late);
    p_.record.event("overruns", what);
    note(
        "the servo loop does not keep its rate: every pass with more than 1 % of overruns is "
        "marked by an event");
    tell("WARNING: " + what);
  }
}

void SessionNotices::note_pass(const protocols::PassResult& result) {
  for (const std::string& trouble : p_.record.markers().troubles()) {
    note(trouble);
  }
  if (result.suspended_ns > 0) {
    const std::string what = fmt::format("{}: {:.3f} s", words_of(p_.record.pass()),
                                         1e-9 * static_cast<double>(result.suspended_ns));
    p_.record.event("suspended", what);
    note(
        fmt::format("the loop was suspended in {}: what was presented then lasted longer, and a "
                    "reaction time over it is not known; repeat the trial",
                    what));
  }
  // A hand that did not carry all the damping was guided less firmly, which an analyst has to know.
  if (result.reduced_ticks > 0) {
    const double rate = p_.request.definition->rate;
    p_.record.note_damping(result.least_gains.damping,
                           static_cast<double>(result.reduced_ticks) / rate);
  }
  if (const double share = result.least_gains.stiffness; share < 1.0) {
    p_.record.event("stiffness_reduced",
                    fmt::format("trial {}: stiffness fell to {:.3f} of the definition's",
                                p_.record.pass().trial, share));
  }
}

void SessionNotices::note_troubles(const record::LiveFigures* live, const Screen* screen) {
  note(live != nullptr ? live->trouble() : "");
  note(p_.loop.real_time_status().notice);
  if (const auto times = p_.loop.resynchronised(); times > 0) {
    note(fmt::format("the loop was suspended {} times and continued at the present time", times));
  }
  if (screen != nullptr) {
    note(screen->summary().notice);
  }
}

void SessionNotices::say_plan(const protocols::Extent& extent, int defined, int over) {
  SessionStatus& status = p_.controller.status();
  status.trials = extent.trials;
  status.blocks = extent.blocks;
  status.trials_defined = defined;
  tell(fmt::format("recording {}{}: {}{}", p_.request.file.string(),
                   p_.request.pilot ? " as a pilot" : "", planned_of(extent, status.trials_defined),
                   over > 0 ? fmt::format(", {} of them done already", over) : ""));
}

void SessionNotices::say_stopped(int trial, const std::string& why) const {
  tell(fmt::format("STOPPED in trial {}: {}; see to it, then clear (c) and start (space)", trial,
                   why));
}

void SessionNotices::say_trial(const PlannedTrial& trial, const char* how) const {
  const double minutes = 1e-9 / 60.0 * static_cast<double>(p_.loop.elapsed_ns());
  const int planned = p_.controller.status().trials;
  // A trial that was aborted comes again under a new number.
  const std::string which = trial.practice ? fmt::format("practice {}", trial.trial)
                            : trial.trial > planned
                                ? fmt::format("trial {}", trial.trial)
                                : fmt::format("trial {} of {}", trial.trial, planned);
  tell(fmt::format("{}, {}: {}, {:.1f} min after the start", which, short_numbers(trial.condition),
                   how, minutes));
}

}  // namespace haptrial::experiments
