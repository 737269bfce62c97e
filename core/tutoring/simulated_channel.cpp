#include "core/tutoring/simulated_channel.h"

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"

namespace haptrial::tutoring {

const Schema<ChannelConditions>& channel_schema() {
  using C = ChannelConditions;
  static const auto schema =
      Schema<C>()
          .number("delay", &C::delay, {0.0, 10.0}, "s",
                  "Delay of the simulated network of a dry run, each way")
          .number("jitter", &C::jitter, {0.0, 1.0}, "s",
                  "Mean of the random delay that each message has beside the constant one")
          .number("loss", &C::loss, {0.0, 1.0}, "1", "Share of messages that never arrive")
          .number("duplication", &C::duplication, {0.0, 1.0}, "1",
                  "Share of messages that arrive twice")
          .number("reordering", &C::reordering, {0.0, 1.0}, "1",
                  "Share of messages that may overtake others")
          .number("bandwidth", &C::bandwidth, {0.0, 1e10}, "bytes/s",
                  "Bandwidth of the simulated network; 0: no limit");
  return schema;
}

SimulatedChannel::SimulatedChannel(const ChannelConditions& conditions, std::uint64_t seed,
                                   std::string_view name)
    : conditions_(conditions), random_(seed, name) {
  waiting_.reserve(kMost);
}

bool SimulatedChannel::later(const Waiting& a, const Waiting& b) noexcept {
  return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
}

// The same number of draws a message whatever becomes of it, so that a change of one condition
// changes nothing else.
void SimulatedChannel::send(const TickBytes& message, double now) noexcept {
  ++sent_;
  const bool lost = random_.uniform() < conditions_.loss;
  const bool twice = random_.uniform() < conditions_.duplication;
  double leaves = now;
  if (conditions_.bandwidth > 0.0) {
    leaves = std::max(now, line_free_) +
             static_cast<double>(message.size() + kOverhead) / conditions_.bandwidth;
    line_free_ = leaves;
  }
  lost_ += put(message, leaves, lost) ? 0 : 1;
  put(message, leaves, lost || !twice);
}

bool SimulatedChannel::put(const TickBytes& message, double leaves, bool lost) noexcept {
  const double extra = -conditions_.jitter * std::log1p(-random_.uniform());
  const bool overtakes = random_.uniform() < conditions_.reordering;
  if (lost || waiting_.size() == kMost) {
    return false;
  }
  double arrival = leaves + conditions_.delay + extra;
  if (!overtakes) {
    arrival = last_arrival_ = std::max(arrival, last_arrival_);
  }
  waiting_.push_back({arrival, order_++, message});
  std::push_heap(waiting_.begin(), waiting_.end(), later);
  return true;
}

std::optional<TickBytes> SimulatedChannel::receive(double now) noexcept {
  if (waiting_.empty() || waiting_.front().arrival > now) {
    return std::nullopt;
  }
  std::pop_heap(waiting_.begin(), waiting_.end(), later);
  const TickBytes bytes = waiting_.back().bytes;
  waiting_.pop_back();
  return bytes;
}

}  // namespace haptrial::tutoring
