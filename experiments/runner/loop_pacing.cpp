#include "experiments/runner/loop_pacing.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/short_numbers.h"
#include "core/record/read/session_facts.h"
#include "experiments/control/signals.h"
#include "experiments/screen/screen.h"

namespace haptrial::experiments {

using Clock = std::chrono::steady_clock;

LoopPacing::LoopPacing(const Parts& parts)
    : p_(parts),
      d_(*parts.request.definition),
      real_(parts.request.clock == realtime::ClockKind::kReal),
      stall_(parts.loop),
      watch_(d_.rate) {}

/// A hand is not guided by a loop that does not catch up. Where nobody feels the forces the pass
/// goes on: what it is worth stands in the file.
void LoopPacing::watch_loop() {
  const auto sentence = watch_.overloaded(Clock::now(), p_.loop.ticks(), p_.loop.overruns());
  if (real_ && sentence && p_.felt && overload_.empty()) {
    overload_ = *sentence;
    p_.task.break_off();
  }
}

void LoopPacing::drive_until_idle() {
  overload_.clear();
  watch_.begin_pass(p_.loop.ticks(), p_.loop.overruns());
  while (!p_.task.idle()) {
    if (real_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } else {
      p_.loop.run(p_.task);
    }
    collect();
    if (p_.rig != nullptr) {
      p_.rig->attend();
    }
    watch_loop();
    publish(p_.record.pass().practice ? "practice" : "running");
    if (asked_to_stop()) {
      p_.task.emergency_stop();
      end_early("interrupted");
    }
  }
  if (real_ && asked_to_stop()) {  // an interrupt ends the pass, too
    end_early("interrupted");
  }
}

/// Collects records, shown pictures and messages since the last call.
void LoopPacing::collect() {
  const std::size_t count = p_.record.collect([this](std::span<const record::Sample> samples) {
    p_.controller.follow(samples, 1e9 / d_.rate);
  });
  if (p_.request.ticks != nullptr) {
    p_.request.ticks->fetch_add(count, std::memory_order_relaxed);
  }
  if (p_.screen != nullptr) {
    p_.record.keep_frames(p_.screen->take_frames());
  }
  p_.controller.take_messages();
  if (p_.hear) {
    p_.hear();
  }
  if (real_ && stall_.stalled()) {
    end_early(DeviceHangs().what());
  }
}

void LoopPacing::meanwhile() {
  collect();
  if (asked_to_stop()) {
    end_early("interrupted");
  }
}

bool LoopPacing::wait(double seconds, const char* state, bool until_asked) {
  PendingRequests& requests = p_.controller.requests();
  requests.start = false;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end && !asked_to_stop() && !requests.abort &&
         !(until_asked && (requests.start || requests.stopped))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    p_.controller.status().break_left = std::chrono::duration<double>(end - Clock::now()).count();
    collect();
    publish(state);
  }
  p_.controller.status().break_left = 0.0;
  return Clock::now() >= end;
}

void LoopPacing::wait_to_begin(const std::string& text) {
  if (p_.controller.attended()) {
    wait_for_experimenter("instructions", text, d_.texts.begin);
  } else if (p_.screen != nullptr) {
    show_text(text, d_.texts.begin_alone);
    wait_for_participant();
  }
}

void LoopPacing::wait_for_experimenter(const char* state, const std::string& text,
                                       const std::string& hint) {
  PendingRequests& requests = p_.controller.requests();
  requests.pause = true;
  std::optional<bool> shown;  // as stopped
  while ((requests.pause || requests.stopped) && !requests.abort) {
    if (shown != requests.stopped) {
      shown = requests.stopped;
      show_text(requests.stopped ? d_.texts.stopped : text, requests.stopped ? "" : hint);
    }
    wait(0.02, requests.stopped ? "stopped" : state);
    if (asked_to_stop()) {
      end_early("interrupted");
    }
  }
}

void LoopPacing::wait_for_participant() {
  p_.begin_pressed->store(false);
  while (!p_.begin_pressed->load()) {
    wait(0.02, "instructions");
    if (asked_to_stop()) {
      end_early("interrupted");
    }
  }
  p_.record.event("start", fmt::format("by the {}", name_of(RequestSource::kWindow)));
}

void LoopPacing::pause_where_asked() {
  const PendingRequests& requests = p_.controller.requests();
  if (requests.stopped || requests.pause) {
    wait_for_experimenter("paused", d_.texts.paused, "");
  }
}

void LoopPacing::recover() {
  if (real_) {
    show_text(d_.texts.recovering, "");
    wait(d_.recovery, "recovering");
  } else {
    const std::uint64_t end = p_.loop.ticks() + static_cast<std::uint64_t>(d_.recovery * d_.rate);
    p_.task.leave_before(end);
    while (p_.loop.ticks() < end) {
      p_.loop.run(p_.task);
      collect();
    }
    p_.task.clear_fault();
  }
}

void LoopPacing::recover_when(const std::function<bool()>& may) {
  show_text(d_.texts.stopped, "");
  while (!may()) {
    wait_a_little("stopped");
  }
  p_.task.clear_fault();
}

void LoopPacing::take_break() {
  const bool until_ready = d_.design.break_until_ready;
  p_.record.event("break", fmt::format("{} s{}", d_.design.break_duration,
                                       until_ready ? ", then until ready" : ""));
  if (real_) {
    rest(!until_ready);
    if (until_ready) {
      wait_until_ready();
    }
    pause_where_asked();
  }
}

/// The handle is taken again in the last seconds.
void LoopPacing::rest(bool until_asked) {
  constexpr double kTakeAgain = 10.0;  // [s]
  const double all = d_.design.break_duration;
  const double last = std::min(kTakeAgain, 0.5 * all);
  show_text(d_.texts.rest, "", all);
  if (wait(all - last, "break", until_asked)) {
    show_text(d_.texts.take_again, "", last);
    wait(last, "break", until_asked);
  }
}

/// Waits until the participant or the experimenter goes on, if there is one of them.
void LoopPacing::wait_until_ready() {
  if (!p_.controller.attended() && p_.screen == nullptr) {
    return;
  }
  const PendingRequests& requests = p_.controller.requests();
  p_.begin_pressed->store(false);
  show_text(d_.texts.take_again, p_.screen != nullptr ? d_.texts.begin_alone : d_.texts.begin);
  while (!requests.abort && !requests.stopped && !requests.pause && !asked_to_stop()) {
    wait(0.02, "break", true);
    if (p_.begin_pressed->load()) {
      p_.record.event("start", fmt::format("by the {}", name_of(RequestSource::kWindow)));
      return;
    }
    if (requests.start) {
      return;
    }
  }
}

void LoopPacing::show_text(const std::string& text, const std::string& hint, double countdown) {
  if (p_.screen != nullptr) {
    render::TextPage page = protocols::page_of(text, hint);
    if (countdown > 0.0) {
      page.countdown = countdown;
    }
    p_.screen->show_text(std::move(page));
  }
  p_.controller.status().screen = text;
  text_shown_ = true;
}

void LoopPacing::show_page(render::TextPage page, const std::string& text) {
  if (p_.screen != nullptr) {
    p_.screen->show_text(std::move(page));
  }
  p_.controller.status().screen = text;
  text_shown_ = true;
}

void LoopPacing::show_progress(double share) {
  if (!real_) {
    return;
  }
  constexpr double kPercent = 100.0;
  show_text(d_.texts.preparing, fmt::format("{:.0f} %", kPercent * std::clamp(share, 0.0, 1.0)));
  publish("preparing");
}

void LoopPacing::wait_for_picture(std::uint64_t number) {
  const PendingRequests& requests = p_.controller.requests();
  const auto start = Clock::now();
  while (!p_.screen->has_shown(number) && p_.screen->trouble().empty() && !requests.abort) {
    wait(0.002, "preparing");
    if (asked_to_stop()) {
      end_early("interrupted");
    }
  }
  const std::chrono::duration<double> waited = Clock::now() - start;
  p_.record.event("first_picture", fmt::format("was shown {:.2f} s after it was asked for; the "
                                               "pass begins now",
                                               waited.count()));
}

void LoopPacing::wait_a_little(const char* state) {
  wait(0.02, state);
  if (asked_to_stop()) {
    end_early("interrupted");
  }
}

void LoopPacing::let_read(const std::string& text, const char* state) {
  constexpr double kTimeToRead = 5.0;  // [s]
  constexpr std::chrono::seconds kLongestSpeech{60};
  show_text(text, "");
  if (p_.screen == nullptr) {
    return;
  }
  wait(kTimeToRead, state, true);
  const auto end = Clock::now() + kLongestSpeech;
  while (p_.speaks && p_.speaks() && Clock::now() < end) {
    wait_a_little(state);
  }
}

void LoopPacing::clear_text() {
  p_.controller.status().screen.clear();
  text_shown_ = false;
}

void LoopPacing::publish(const char* state) {
  if (!p_.controller.attended()) {
    return;
  }
  SessionStatus& status = p_.controller.status();
  const record::PassRow& pass = p_.record.pass();
  status.trial = pass.trial;
  status.practice = pass.practice;
  status.elapsed = 1e-9 * static_cast<double>(p_.loop.elapsed_ns());
  status.block = pass.block;
  status.condition = short_numbers(pass.condition);
  status.phase = record::name_of(pass.phase);
  status.ticks = p_.loop.ticks();
  status.overruns = p_.loop.overruns();
  status.dropped = p_.record.dropped();
  if (p_.live != nullptr) {
    status.figures = p_.live->now();
  }
  p_.controller.publish(state);
}

bool LoopPacing::asked_to_stop() const {
  return interrupted() ||
         (p_.request.cancel != nullptr && p_.request.cancel->load(std::memory_order_relaxed));
}

void LoopPacing::end_early(const std::string& why) const {
  throw RunError(real_
                     ? fmt::format("{}; what was recorded is in {}.partial; continue with --resume",
                                   why, p_.request.file.string())
                     : why);
}

void LoopWatch::begin_pass(std::uint64_t ticks, std::uint64_t overruns) {
  begin_ = {{}, ticks, overruns};
  moments_.clear();
}

std::optional<std::string> LoopWatch::overloaded(Time now, std::uint64_t ticks,
                                                 std::uint64_t overruns) {
  constexpr std::chrono::seconds kWindow{1};
  constexpr double kShare = 0.2;
  moments_.push_back({now, ticks, overruns});
  while (moments_.size() > 2 && now - moments_[1].time >= kWindow) {
    moments_.pop_front();
  }
  const Moment& first = moments_.front();
  const double seconds = std::chrono::duration<double>(now - first.time).count();
  if (now - first.time < kWindow) {
    return std::nullopt;
  }
  const auto made = static_cast<double>(ticks - first.ticks);
  const auto late = static_cast<double>(overruns - first.overruns);
  if (made >= (1.0 - kShare) * rate_hz_ * seconds || late <= kShare * made) {
    return std::nullopt;
  }
  return fmt::format(
      "the servo loop is overloaded: {:.0f} of {:.0f} ticks a second, {:.0f} % of "
      "them overran their period",
      made / seconds, rate_hz_, 100.0 * late / made);
}

std::optional<std::string> LoopWatch::end_pass(std::uint64_t ticks, std::uint64_t overruns) const {
  return record::too_many_overruns(ticks - begin_.ticks, overruns - begin_.overruns);
}

}  // namespace haptrial::experiments
