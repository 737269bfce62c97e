#include "core/network/channel/channel_conditions.h"

#include "core/base/definition/table.h"

namespace haptrial::network {

ChannelConditions read_channel_conditions(Table& table) {
  ChannelConditions c;
  c.delay = table.number_or("delay", c.delay, {0.0, 10.0}, "s");
  c.jitter = table.number_or("jitter", c.jitter, {0.0, 1.0}, "s");
  c.loss = table.number_or("loss", c.loss, {0.0, 1.0}, "1");
  c.duplication = table.number_or("duplication", c.duplication, {0.0, 1.0}, "1");
  c.reordering = table.number_or("reordering", c.reordering, {0.0, 1.0}, "1");
  c.bandwidth = table.number_or("bandwidth", c.bandwidth, {0.0, 1e10}, "bytes/s");
  return c;
}

}  // namespace haptrial::network
