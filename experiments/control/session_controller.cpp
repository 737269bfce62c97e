#include "experiments/control/session_controller.h"

#include <fmt/format.h>

#include <utility>

namespace haptrial::experiments {

SessionController::SessionController(SessionControl* control, Actions actions)
    : control_(control), actions_(std::move(actions)) {}

void SessionController::follow(std::span<const record::Sample> samples, double period_ns) {
  if (attended()) {
    live_.follow(samples, period_ns);
  }
}

void SessionController::take_messages() {
  if (!attended()) {
    return;
  }
  for (const SessionControl::Message& message : control_->take()) {
    if (message.answers > 0) {
      answers_.push_back(message);
    } else if (message.is_note) {
      actions_.event(message.bad_trial ? "bad_trial" : "note", trial_of(message) + message.text);
    } else {
      heed(message.request, message.by);
    }
  }
}

/// "trial 5: ", before what an experimenter writes about it; a refusal of the console is of none.
std::string SessionController::trial_of(const SessionControl::Message& message) const {
  if (status_.trial < 1 || message.text.starts_with("console: ")) {
    return "";
  }
  return fmt::format("{} {}: ", status_.practice ? "practice trial" : "trial", status_.trial);
}

std::vector<SessionControl::Message> SessionController::take_answers() {
  return std::exchange(answers_, {});
}

void SessionController::heed(Request request, RequestSource by) {
  const std::string who = std::string("by the ") + name_of(by);
  switch (request) {
    case Request::kStart:
      requests_.start = true;
      requests_.pause = false;
      actions_.event("start", who);
      break;
    case Request::kPause:
      requests_.pause = true;
      break;
    case Request::kRepeatTrial:
      requests_.repeat = true;
      actions_.break_off();
      break;
    case Request::kSkipTrial:
      requests_.skip = true;
      actions_.break_off();
      break;
    case Request::kEnd:
      requests_.for_good = true;
      [[fallthrough]];
    case Request::kAbort:
      requests_.abort = true;
      actions_.break_off();
      break;
    case Request::kEmergencyStop:  // the force is zero already
      requests_.stopped = true;
      if (!std::exchange(stop_recorded_, true)) {
        actions_.event("emergency_stop", who);
      }
      break;
    case Request::kClear:
      requests_.stopped = stop_recorded_ = false;
      requests_.pause = true;  // goes on when the experimenter says so
      status_.fault.clear();
      actions_.clear_fault();
      actions_.event("clear", who);
      break;
    case Request::kBack:
      requests_.back = true;
      break;
    case Request::kTakeBack:
      if (status_.can_take_back) {
        requests_.take_back = by;
        actions_.break_off();
      }
      break;
    case Request::kTakeLead:
    case Request::kHandOver:
      if (actions_.lead) {
        actions_.lead(request == Request::kTakeLead);
        actions_.event(request == Request::kTakeLead ? "take_lead" : "hand_over", who);
      }
      break;
  }
}

void SessionController::publish(const std::string& state) {
  constexpr std::chrono::milliseconds kBetween{50};
  const auto now = std::chrono::steady_clock::now();
  if (!attended() || (now - published_ < kBetween && status_.state == state)) {
    return;
  }
  published_ = now;
  status_.state = state;
  rate_.add(now, status_.ticks);
  status_.rate_measured = rate_.rate();
  live_.fill(status_);
  control_->publish(status_);
}

void TickRate::add(Time now, std::uint64_t ticks) {
  constexpr std::chrono::seconds kWindow{1};
  moments_.push_back({now, ticks});
  while (moments_.size() > 2 && now - moments_[1].time >= kWindow) {
    moments_.pop_front();
  }
}

double TickRate::rate() const {
  constexpr double kShortest = 0.5;  // [s]
  if (moments_.empty()) {
    return 0.0;
  }
  const std::chrono::duration<double> time = moments_.back().time - moments_.front().time;
  const std::uint64_t ticks = moments_.back().ticks - moments_.front().ticks;
  return time.count() < kShortest ? 0.0 : static_cast<double>(ticks) / time.count();
}

}  // namespace haptrial::experiments
