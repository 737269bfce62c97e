#pragma once

namespace haptrial {
template <class T>
class Schema;
}

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

}  // namespace haptrial::tutoring
