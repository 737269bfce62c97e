#include "experiments/runner/aborted_pass.h"

#include <fmt/format.h>

namespace haptrial::experiments {

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

std::string AbortedPass::cause(const protocols::PassResult& result) const {
  const std::string fault = device::describe(result.fault);
  return p_.definition.devices() > 1 ? fmt::format("device {}: {}", result.device + 1, fault)
                                     : fault;
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
