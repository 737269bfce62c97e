#include "experiments/session_control.h"

#include <utility>

namespace haptrial::experiments {

void SessionControl::on_emergency(std::function<void()> stop) {
  const std::lock_guard lock(mutex_);
  stop_ = std::move(stop);
}

void SessionControl::ask(Request request) {
  const std::lock_guard lock(mutex_);
  if (request == Request::kEmergencyStop && stop_) {
    stop_();
  }
  messages_.push_back({false, request, ""});
}

void SessionControl::note(std::string text) {
  constexpr std::size_t kLongest = 2000;
  if (text.size() > kLongest) {
    text.resize(kLongest);
  }
  const std::lock_guard lock(mutex_);
  messages_.push_back({true, Request::kStart, std::move(text)});
}

std::vector<SessionControl::Message> SessionControl::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

void SessionControl::publish(SessionStatus status) {
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
}

SessionStatus SessionControl::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace haptrial::experiments
