#include "analysis/exchange/channel_findings.h"

#include "analysis/quality/channel_quality.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

FindingRow row_of(const record::SessionInfo& info, const ChannelQuality& c) {
  return {
      {.name = "participant", .title = "Participant", .value = info.subject},
      {.name = "session", .title = "Session", .value = info.session},
      {.name = "channel", .title = "Channel", .value = c.name},
      {.name = "samples", .title = "Samples", .value = c.samples},
      {.name = "rate", .title = "A second", .value = c.rate(), .unit = "Hz"},
      {.name = "uncertainty", .title = "Times within, median", .value = c.uncertainty, .unit = "s"},
      {.name = "largest_uncertainty",
       .title = "at most",
       .value = c.largest_uncertainty,
       .unit = "s"},
      {.name = "missing", .title = "Missing", .value = c.missing},
      {.name = "losses", .title = "Times lost", .value = c.losses},
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
