#include "core/tutoring/channel_conditions.h"

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

}  // namespace haptrial::tutoring
