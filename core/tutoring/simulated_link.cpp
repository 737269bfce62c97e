#include "core/tutoring/simulated_link.h"

#include <cmath>

namespace haptrial::tutoring {

SimulatedLink::SimulatedLink(const ChannelConditions& conditions, double least_delay,
                             std::uint64_t seed, double rate)
    : first_(conditions, least_delay, seed, "there", rate),
      second_(conditions, least_delay, seed, "back", rate) {
  first_.other_ = &second_;
  second_.other_ = &first_;
}

SimulatedLink::End::End(const ChannelConditions& conditions, double least_delay, std::uint64_t seed,
                        std::string_view name, double rate)
    : rate_(rate),
      ahead_(static_cast<std::uint64_t>(least_delay * rate)),
      out_(conditions, seed, name) {}

double SimulatedLink::End::seconds(std::uint64_t tick) const noexcept {
  return static_cast<double>(tick) / rate_;
}

std::int64_t SimulatedLink::End::tick() noexcept {
  begun_.store(++now_, std::memory_order_release);
  begun_.notify_all();
  const std::uint64_t needed = now_ > ahead_ ? now_ - ahead_ : 0;
  std::uint64_t others = other_->begun_.load(std::memory_order_acquire);
  while (others < needed) {
    other_->begun_.wait(others, std::memory_order_acquire);
    others = other_->begun_.load(std::memory_order_acquire);
  }
  // Both sides see the end at the same tick, however early the other thread was through.
  other_closed_ = others == kClosed && needed > other_->ended_at_;
  return std::llround(1e9 * seconds(now_));
}

/// The other side may be within its tick of the same number: what it sends then comes later.
void SimulatedLink::End::receive(Listener& listener) noexcept {
  const double until = seconds(now_) - 0.5 / rate_;
  const std::lock_guard lock(other_->mutex_);
  while (const auto bytes = other_->out_.receive(until)) {
    if (const auto message = decode(*bytes)) {
      accepted_.fetch_add(1, std::memory_order_relaxed);
      listener.hear({*message, std::llround(1e9 * seconds(now_))});
    }
  }
}

void SimulatedLink::End::send(const TickMessage& message) noexcept {
  sent_.fetch_add(1, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  out_.send(encode(message), seconds(now_));
}

void SimulatedLink::End::change(const ChannelConditions& conditions) noexcept {
  const std::lock_guard lock(mutex_);
  out_.change(conditions);
}

void SimulatedLink::End::close(const TickMessage& /*last*/) noexcept {
  if (begun_.load(std::memory_order_relaxed) == kClosed) {
    return;  // the other side reads ended_at_ by now
  }
  ended_at_ = now_;
  begun_.store(kClosed, std::memory_order_release);
  begun_.notify_all();
}

WireCounts SimulatedLink::End::counts() const noexcept {
  WireCounts counts;
  counts.sent = sent_.load(std::memory_order_relaxed);
  counts.accepted = accepted_.load(std::memory_order_relaxed);
  return counts;
}

}  // namespace haptrial::tutoring
