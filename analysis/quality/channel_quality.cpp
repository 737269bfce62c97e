#include "analysis/quality/channel_quality.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "core/record/read/session_reader.h"
#include "core/record/table/schema.h"

namespace haptrial::analysis {
namespace {

constexpr std::string_view kPrefix = "channel_";

std::size_t field_of(const record::TableDescription& table, std::string_view column) {
  const auto found = std::ranges::find_if(
      table.fields(), [&](const record::Field& field) { return field.column.name == column; });
  return static_cast<std::size_t>(found - table.fields().begin());
}

ChannelQuality quality_of(const record::SessionReader& reader, const std::string& table_name) {
  const auto table = reader.description(table_name);
  ChannelQuality quality;
  quality.name = table_name.substr(kPrefix.size());
  quality.samples = reader.count(*table);
  if (quality.samples == 0) {
    return quality;
  }
  const std::uint64_t last = quality.samples - 1;
  const auto at = [&](const char* column, std::uint64_t row) {
    return reader.integers(*table, column, row, 1).front();
  };
  const auto numbered = static_cast<std::uint64_t>(at("sample", last) - at("sample", 0)) + 1;
  quality.missing = numbered - quality.samples;
  quality.first = 1e-9 * static_cast<double>(at("time_ns", 0));
  quality.seconds = 1e-9 * static_cast<double>(at("time_ns", last) - at("time_ns", 0));
  std::vector<double> all(quality.samples);
  const std::array<record::ColumnTarget, 1> targets{
      {{field_of(*table, "uncertainty"), reinterpret_cast<std::uint8_t*>(all.data())}}};
  reader.columns(*table, 0, quality.samples, targets);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  quality.uncertainty = *middle;
  quality.largest_uncertainty = *std::max_element(all.begin(), all.end());
  return quality;
}

/// Finds the intervals between samples in which the channel was lost. A loss before the first
/// sample or after the last is in none of them.
/// @param losses  their times
void find_silence(const record::SessionReader& reader, const std::vector<std::int64_t>& losses,
                  ChannelQuality& quality) {
  if (losses.empty() || quality.samples < 2) {
    return;
  }
  const auto table = reader.description(std::string(kPrefix) + quality.name);
  const std::vector<std::int64_t> times = reader.integers(*table, "time_ns", 0, quality.samples);
  std::set<std::size_t> breaks;  // by the sample that ends them
  for (const std::int64_t loss : losses) {
    breaks.insert(static_cast<std::size_t>(std::ranges::upper_bound(times, loss) - times.begin()));
  }
  breaks.erase(0);
  breaks.erase(times.size());
  std::int64_t silence = 0;
  for (const std::size_t i : breaks) {
    silence += times[i] - times[i - 1];
  }
  quality.breaks = breaks.size();
  quality.silence = 1e-9 * static_cast<double>(silence);
}

}  // namespace

std::vector<channel::IncidentRow> channel_incidents(const record::SessionReader& reader) {
  if (!reader.has(record::table_of<channel::IncidentRow>())) {
    return {};
  }
  constexpr std::size_t kFull = record::kTextBytes - 3;  // bytes, as a cut divides no character
  std::vector<channel::IncidentRow> whole;
  std::size_t before = 0;  // bytes of the row before
  for (channel::IncidentRow& row : reader.rows<channel::IncidentRow>()) {
    const std::size_t bytes = row.text.size();
    const bool goes_on = before >= kFull && bytes > 0 && row.time_ns == whole.back().time_ns &&
                         row.channel == whole.back().channel && row.what == whole.back().what &&
                         row.amount == whole.back().amount;
    if (goes_on) {
      whole.back().text += row.text;
    } else {
      whole.push_back(std::move(row));
    }
    before = bytes;
  }
  return whole;
}

double ChannelQuality::rate() const {
  return seconds > silence ? static_cast<double>(samples - 1 - breaks) / (seconds - silence) : 0.0;
}

std::vector<ChannelQuality> channel_quality(const record::SessionReader& reader) {
  const record::TableDescription& incidents = record::table_of<channel::IncidentRow>();
  std::vector<ChannelQuality> all;
  if (!reader.has(incidents)) {
    return all;
  }
  for (const std::string& name : reader.table_names()) {
    if (name.starts_with(kPrefix) && name != incidents.name()) {
      all.push_back(quality_of(reader, name));
    }
  }
  std::ranges::sort(all, {}, &ChannelQuality::name);
  std::map<std::string, std::vector<std::int64_t>> losses;  // their times, by channel
  for (const channel::IncidentRow& row : channel_incidents(reader)) {
    const auto found = std::ranges::find(all, row.channel, &ChannelQuality::name);
    if (found != all.end()) {
      found->losses += row.what == channel::Incident::kLost ? 1 : 0;
      found->faults += row.what == channel::Incident::kStatus && row.amount != 0.0 ? 1 : 0;
      found->clock_steps += row.what == channel::Incident::kClockStep ? 1 : 0;
      found->messages += row.what == channel::Incident::kMessage ? 1 : 0;
    }
    if (row.what == channel::Incident::kLost) {
      losses[row.channel].push_back(row.time_ns);
    }
  }
  for (ChannelQuality& quality : all) {
    find_silence(reader, losses[quality.name], quality);
  }
  return all;
}

}  // namespace haptrial::analysis
