#include "core/stream/neon_events.h"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include <httplib.h>

namespace haptrial::markers {
namespace {

constexpr int kUsualPort = 8080;
constexpr std::chrono::milliseconds kAnswerWithin{1500};

int port_of(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  int port = kUsualPort;
  if (colon != std::string::npos) {
    std::from_chars(address.data() + colon + 1, address.data() + address.size(), port);
  }
  return port;
}

/// The phone's clock counts from 1970, as this computer's does [ns].
std::int64_t wall_time() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

NeonEvents::NeonEvents(const std::string& address, std::function<std::int64_t()> now)
    : host_(address.substr(0, address.rfind(':'))), port_(port_of(address)), now_(std::move(now)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void NeonEvents::send(const TimedOnset& onset, std::string name) {
  {
    const std::lock_guard lock(mutex_);
    asked_.push_back({onset, std::move(name)});
  }
  changed_.notify_all();
}

void NeonEvents::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !asked_.empty(); }) && !stop.stop_requested()) {
    const PendingEvent asked = asked_.front();
    lock.unlock();
    const std::string wrong = post(asked);
    const std::int64_t answered = now_();
    lock.lock();
    if (asked_.empty() || asked_.front().onset.number != asked.onset.number) {
      continue;  // given up meanwhile
    }
    asked_.pop_front();
    sent_.push_back({asked.onset, wrong.empty() ? answered : -1});
    if (trouble_.empty() && !wrong.empty()) {
      trouble_ = fmt::format(
          "the Neon at {}:{} {}; the session goes on, and /markers says which events it took",
          host_, port_, wrong);
    }
  }
}

/// @returns why the phone did not take it; empty if it did
std::string NeonEvents::post(const PendingEvent& asked) const {
  httplib::Client client(host_, port_);
  client.set_connection_timeout(kAnswerWithin);
  client.set_read_timeout(kAnswerWithin);
  const std::int64_t time = wall_time() - (now_() - asked.onset.time_ns);
  const nlohmann::json event{{"name", asked.name}, {"timestamp", time}};
  const auto answer = client.Post("/api/event", event.dump(), "application/json");
  if (!answer) {
    return "did not answer to an event";
  }
  return answer->status == 200 ? "" : fmt::format("refused an event (status {})", answer->status);
}

std::vector<NeonEvent> NeonEvents::take_sent() {
  const std::lock_guard lock(mutex_);
  return std::exchange(sent_, {});
}

bool NeonEvents::all_sent() const {
  const std::lock_guard lock(mutex_);
  return asked_.empty();
}

void NeonEvents::give_up() {
  const std::lock_guard lock(mutex_);
  for (const PendingEvent& asked : asked_) {
    sent_.push_back({asked.onset, -1});
  }
  asked_.clear();
}

std::string NeonEvents::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

}  // namespace haptrial::markers
