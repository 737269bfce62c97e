#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/base/random.h"
#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// Effects of a network on messages in one direction.
struct ChannelConditions {
  double delay{0.0};        // least [s]
  double jitter{0.0};       // mean of what comes on top, exponentially distributed [s]
  double loss{0.0};         // share, 0 to 1
  double duplication{0.0};  // share that comes twice, each copy with a jitter of its own
  double reordering{0.0};   // share that does not wait for those before it
  double bandwidth{0.0};    // [bytes/s]; 0: no limit

  bool operator==(const ChannelConditions&) const = default;
};

/// The keys of [tutoring.channel], and of a network of [[tutoring.networks]].
const Schema<ChannelConditions>& channel_schema();

/// One way of a network on the simulated clock: what arrives when is a function of what was sent
/// when, of the conditions and of a named stream, to the bit. Servo thread: no allocation, lock,
/// I/O or throw after the constructor.
class SimulatedChannel {
 public:
  /// Messages under way at once; more are lost and counted, as by a router without memory.
  static constexpr std::size_t kMost = 4096;
  /// Bytes on each message's way beside its own: IP, UDP, and authentication.
  static constexpr std::size_t kOverhead = 28 + 40;

  SimulatedChannel(const ChannelConditions& conditions, std::uint64_t seed, std::string_view name);

  /// @param now  not before that of the last call [s]
  void send(const TickBytes& message, double now) noexcept;
  /// The next message that has arrived by now, in the order of arrival; nothing where none has.
  std::optional<TickBytes> receive(double now) noexcept;

  /// Sets the conditions from the next message on.
  void change(const ChannelConditions& conditions) noexcept { conditions_ = conditions; }

  std::uint64_t sent() const noexcept { return sent_; }
  std::uint64_t lost() const noexcept { return lost_; }
  std::size_t under_way() const noexcept { return waiting_.size(); }

 private:
  struct Waiting {
    double arrival{0.0};  // [s]
    std::uint64_t order{0};
    TickBytes bytes{};
  };
  static bool later(const Waiting& a, const Waiting& b) noexcept;
  bool put(const TickBytes& message, double leaves, bool lost) noexcept;

  ChannelConditions conditions_;
  RandomStream random_;
  std::vector<Waiting> waiting_;  // a heap, the next to arrive in front
  double line_free_{0.0};         // when the bandwidth lets the next message go [s]
  double last_arrival_{0.0};      // of those that keep their order [s]
  std::uint64_t order_{0};
  std::uint64_t sent_{0};
  std::uint64_t lost_{0};
};

}  // namespace haptrial::tutoring
