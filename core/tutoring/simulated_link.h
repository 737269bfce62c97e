#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "core/tutoring/simulated_channel.h"
#include "core/tutoring/wire.h"

namespace haptrial::tutoring {

/// Two sessions on simulated clocks, each on a thread of its own, joined by a simulated network.
/// Their ticks go side by side: a tick begins when all is known that can arrive before it, so that
/// nothing depends on the threads. By as many ticks as the delay has, one may be ahead.
class SimulatedLink {
 public:
  /// @param conditions   of either way, at first
  /// @param least_delay  that it ever has [s]
  /// @param rate         of both loops [Hz]
  SimulatedLink(const ChannelConditions& conditions, double least_delay, std::uint64_t seed,
                double rate);
  SimulatedLink(const ChannelConditions& conditions, std::uint64_t seed, double rate)
      : SimulatedLink(conditions, conditions.delay, seed, rate) {}

  /// @param side  0 or 1; each end belongs to one thread
  Wire& end(int side) noexcept { return side == 0 ? first_ : second_; }

 private:
  class End final : public Wire {
   public:
    End(const ChannelConditions& conditions, double least_delay, std::uint64_t seed,
        std::string_view name, double rate);
    std::int64_t tick() noexcept override;
    void receive(Listener& listener) noexcept override;
    void send(const TickMessage& message) noexcept override;
    void change(const ChannelConditions& conditions) noexcept override;
    bool closed() const noexcept override { return other_closed_; }
    void close(const TickMessage& last) noexcept override;
    WireCounts counts() const noexcept override;

   private:
    friend class SimulatedLink;
    static constexpr std::uint64_t kClosed = ~std::uint64_t{0} >> 1;  // later than any tick
    double seconds(std::uint64_t tick) const noexcept;

    End* other_{nullptr};
    double rate_;
    std::uint64_t ahead_;                  // ticks by which this end may be ahead of the other
    std::uint64_t now_{0};                 // the tick that has begun, from 1
    std::uint64_t ended_at_{0};            // the last one, before it was closed
    std::atomic<std::uint64_t> begun_{0};  // the same for the other thread
    bool other_closed_{false};
    std::mutex mutex_;
    SimulatedChannel out_;  // under the mutex
    std::atomic<std::uint64_t> sent_{0};
    std::atomic<std::uint64_t> accepted_{0};
  };

  End first_;
  End second_;
};

}  // namespace haptrial::tutoring
