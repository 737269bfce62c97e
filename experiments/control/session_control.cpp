#include "experiments/control/session_control.h"

#include <utility>

namespace haptrial::experiments {

void SessionControl::on_emergency(std::function<void()> stop) {
  const std::lock_guard lock(stop_mutex_);
  stop_ = std::move(stop);
}

void SessionControl::on_mirror(std::function<std::string()> picture) {
  const std::lock_guard lock(mirror_mutex_);
  picture_ = std::move(picture);
}

std::string SessionControl::mirror() {
  const std::lock_guard lock(mirror_mutex_);
  return picture_ ? picture_() : "";
}

const char* name_of(RequestSource by) noexcept {
  switch (by) {
    case RequestSource::kConsole:
      return "console";
    case RequestSource::kTerminal:
      return "terminal";
    case RequestSource::kWindow:
      return "window";
  }
  return "";
}

void SessionControl::ask(Request request, RequestSource by) {
  if (request == Request::kEmergencyStop) {
    const std::lock_guard lock(stop_mutex_);
    if (stop_) {
      stop_();
    }
  }
  const std::lock_guard lock(mutex_);
  messages_.push_back({false, request, "", by});
}

void SessionControl::note(std::string text, bool bad_trial) {
  constexpr std::size_t kLongest = 2000;
  if (text.size() > kLongest) {
    text.resize(kLongest);
  }
  const std::lock_guard lock(mutex_);
  messages_.push_back(
      {true, Request::kStart, std::move(text), RequestSource::kConsole, 0, bad_trial});
}

void SessionControl::answer(int number, std::string text, RequestSource by) {
  const std::lock_guard lock(mutex_);
  messages_.push_back({false, Request::kStart, std::move(text), by, number});
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
