#include "analysis/exchange/channel_findings.h"

#include "analysis/quality/channel_quality.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

/// A figure that takes `least` samples.
Finding figure(const char* name, const char* title, double value, const char* unit,
               const ChannelQuality& c, std::uint64_t least) {
  Finding finding{.name = name, .title = title, .unit = unit};
  if (c.samples >= least) {
    finding.value = value;
  } else {
    finding.why_not = c.samples == 0 ? "no sample came" : "one sample came";
  }
  return finding;
}

FindingRow row_of(const record::SessionInfo& info, const ChannelQuality& c) {
  return {{.name = "participant", .title = "Participant", .value = info.subject},
          {.name = "session", .title = "Session", .value = info.session},
          {.name = "channel", .title = "Channel", .value = c.name},
          {.name = "samples", .title = "Samples", .value = c.samples},
          figure("rate", "A second", c.rate(), "Hz", c, 2),
          figure("uncertainty", "Times within, median", c.uncertainty, "s", c, 1),
          figure("largest_uncertainty", "at most", c.largest_uncertainty, "s", c, 1),
          {.name = "missing", .title = "Missing", .value = c.missing},
          {.name = "losses", .title = "Times lost", .value = c.losses},
          {.name = "faults", .title = "Faults that it stated", .value = c.faults},
          {.name = "clock_steps", .title = "Steps of its clock", .value = c.clock_steps}};
}

}  // namespace

FindingList channel_findings(const std::vector<std::filesystem::path>& sessions) {
  FindingTable table{"channels", "Samples of each channel, and how well their times are known"};
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader reader(file);
    for (const ChannelQuality& quality : channel_quality(reader)) {
      table.rows.push_back(row_of(reader.info(), quality));
    }
  }
  FindingList list{"channels", "Channels"};
  if (!table.rows.empty()) {
    list.tables.push_back(std::move(table));
  }
  return list;
}

}  // namespace haptrial::analysis
