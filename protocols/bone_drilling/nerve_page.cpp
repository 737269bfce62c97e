#include "protocols/bone_drilling/nerve_page.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/bone/nerve/monitor.h"

namespace haptrial::protocols {
namespace {

using nlohmann::json;

constexpr double kStep = 1e-7;             // of samples on the page [V]
constexpr double kLeastThreshold = 10e-6;  // [V]
constexpr double kMostThreshold = 400e-6;  // [V]

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

json probe_json(const nerve::MonitorProbe& probe) {
  json out{{"current", probe.current}, {"searching", nullptr}, {"found", nullptr}};
  if (probe.searching) {
    out["searching"] = *probe.searching;
  }
  if (probe.found) {
    out["found"] = {{"channel", probe.found->channel},
                    {"current", probe.found->current},
                    {"out_of_range", probe.found->out_of_range}};
  }
  return out;
}

/// The view as one line of JSON.
std::string nerve_json(const nerve::MonitorBuffer::View& view) {
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
                 {"simulated", true},    {"column", nerve::MonitorBuffer::kColumn},
                 {"channels", channels}, {"events", events},
                 {"columns", columns},   {"probe", probe_json(view.probe)}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Whether an object of `size` members has this number within a range, which it then gives.
bool number(const json& body, std::size_t size, const char* name, double least, double most,
            double& value) {
  if (!body.is_object() || body.size() != size || !body.contains(name) || !body[name].is_number()) {
    return false;
  }
  constexpr double kRounding = 1e-9;
  value = body[name].get<double>();
  return value >= least - kRounding && value <= most + kRounding;
}

}  // namespace

AuxiliaryPage::Events NervePage::events() {
  return [buffer = buffer_, column = std::uint64_t{0}, event = std::uint64_t{0}]() mutable {
    const nerve::MonitorBuffer::View view = buffer->since(column, event);
    column = view.next_column;
    event = view.next_event;
    return nerve_json(view);
  };
}

void NervePage::ask(const std::string& json) { buffer_->ask(parse_nerve_order(json)); }

nerve::MonitorOrder parse_nerve_order(const std::string& text) {
  using What = nerve::MonitorOrder::What;
  const json body = json::parse(text, nullptr, false);
  nerve::MonitorOrder order;
  if (number(body, 1, "stimulus", nerve::kLeastStimulus, nerve::kMostStimulus, order.current)) {
    order.what = What::kStimulus;
    return order;
  }
  const bool of_channel = body.is_object() && body.size() == 2 && body.contains("channel") &&
                          body["channel"].is_number_unsigned() &&
                          body["channel"].get<std::uint64_t>() < nerve::kMostChannels;
  if (of_channel && body.contains("muted") && body["muted"].is_boolean()) {
    order.what = What::kMute;
    order.muted = body["muted"].get<bool>();
  } else if (of_channel && body.contains("search") && body["search"] == true) {
    order.what = What::kSearch;
  } else if (!of_channel ||
             !number(body, 2, "threshold", kLeastThreshold, kMostThreshold, order.threshold)) {
    throw InputError(
        "the body must be an object with the number \"channel\" (from 0) and one of \"muted\", "
        "true "
        "or false, \"threshold\", 1e-05 to 0.0004 [V], and \"search\", true; or with \"stimulus\" "
        "alone, 5e-05 to 0.003 [A]");
  }
  order.channel = body["channel"].get<std::size_t>();
  return order;
}

}  // namespace haptrial::protocols
