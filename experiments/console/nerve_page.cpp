#include "experiments/console/nerve_page.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

using nlohmann::json;

constexpr double kStep = 1e-7;  // of samples on the page [V]

int in_steps(float volts) {
  return static_cast<int>(std::lround(static_cast<double>(volts) / kStep));
}

json channel_json(const nerve::MonitorChannel& c) {
  return {{"name", c.name},           {"nerve", c.nerve},
          {"threshold", c.threshold}, {"muted", c.muted},
          {"tone", c.tone},           {"shown", c.shown},
          {"frequency", c.frequency}, {"train_time", c.train_time},
          {"events", c.events},       {"artefacts", c.artefacts}};
}

}  // namespace

std::string nerve_json(const nerve::MonitorDesk::View& view) {
  json channels = json::array();
  for (const nerve::MonitorChannel& channel : view.channels) {
    channels.push_back(channel_json(channel));
  }
  json events = json::array();
  for (const nerve::MonitorEvent& e : view.events) {
    events.push_back({{"time", e.time},
                      {"channel", e.channel},
                      {"kind", e.kind},
                      {"duration", e.duration},
                      {"peak", e.peak},
                      {"threshold", e.threshold},
                      {"train_time", e.train_time}});
  }
  std::vector<int> columns;
  columns.reserve(2 * view.columns.size());
  for (const nerve::MonitorColumn& column : view.columns) {
    columns.push_back(in_steps(column.low));
    columns.push_back(in_steps(column.high));
  }
  const json out{{"time", view.time},    {"heard", view.heard},
                 {"simulated", true},    {"column", nerve::MonitorDesk::kColumn},
                 {"channels", channels}, {"events", events},
                 {"columns", columns}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

nerve::MonitorOrder parse_nerve_order(const std::string& text) {
  constexpr double kLeast = 10e-6;  // [V]
  constexpr double kMost = 400e-6;  // [V]
  constexpr std::int64_t kChannels = 8;
  const json body = json::parse(text, nullptr, false);
  const bool channel = !body.is_discarded() && body.is_object() && body.size() == 2 &&
                       body.contains("channel") && body["channel"].is_number_unsigned() &&
                       body["channel"].get<std::int64_t>() < kChannels;
  nerve::MonitorOrder order;
  if (channel && body.contains("muted") && body["muted"].is_boolean()) {
    order.mutes = true;
    order.muted = body["muted"].get<bool>();
  } else if (channel && body.contains("threshold") && body["threshold"].is_number()) {
    order.threshold = body["threshold"].get<double>();
  }
  if (!order.mutes && !(order.threshold >= kLeast - 1e-9 && order.threshold <= kMost + 1e-9)) {
    throw InputError(
        "the body must be an object with the number \"channel\" (from 0) and either \"muted\", "
        "true "
        "or false, or \"threshold\", 1e-05 to 0.0004 [V]");
  }
  order.channel = body["channel"].get<std::size_t>();
  return order;
}

}  // namespace haptrial::experiments
