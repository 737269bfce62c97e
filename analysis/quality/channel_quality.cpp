#include "analysis/quality/channel_quality.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
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

/// The longest intervals between samples are those of the breaks.
void find_silence(const record::SessionReader& reader, ChannelQuality& quality) {
  quality.breaks = std::min(quality.breaks, quality.samples > 1 ? quality.samples - 2 : 0);
  if (quality.breaks == 0) {
    return;
  }
  const auto table = reader.description(std::string(kPrefix) + quality.name);
  const std::vector<std::int64_t> times = reader.integers(*table, "time_ns", 0, quality.samples);
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) {
    intervals.push_back(times[i] - times[i - 1]);
  }
  const auto longest = intervals.begin() + static_cast<std::ptrdiff_t>(quality.breaks);
  std::ranges::nth_element(intervals, longest, std::greater{});
  quality.silence =
      1e-9 * static_cast<double>(std::accumulate(intervals.begin(), longest, std::int64_t{0}));
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
  for (const channel::IncidentRow& row : channel_incidents(reader)) {
    const auto found = std::ranges::find(all, row.channel, &ChannelQuality::name);
    if (found != all.end()) {
      found->breaks += row.what == channel::Incident::kBack ? 1 : 0;
      found->losses += row.what == channel::Incident::kLost ? 1 : 0;
      found->clock_steps += row.what == channel::Incident::kClockStep ? 1 : 0;
      found->messages += row.what == channel::Incident::kMessage ? 1 : 0;
    }
  }
  for (ChannelQuality& quality : all) {
    find_silence(reader, quality);
  }
  return all;
}

}  // namespace haptrial::analysis
