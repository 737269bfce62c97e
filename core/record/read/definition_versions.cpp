#include "core/record/read/definition_versions.h"

#include <algorithm>

#include "core/record/read/session_reader.h"

namespace haptrial::record {
namespace {

/// Sequence number of the first sample at this time or later; nothing if there is none.
std::optional<std::uint64_t> sequence_at(const SessionReader& reader, std::int64_t time_ns) {
  std::uint64_t low = 0;
  std::uint64_t high = reader.sample_count();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (reader.samples(middle, 1).front().time_ns < time_ns) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < reader.sample_count() ? std::optional(reader.samples(low, 1).front().sequence)
                                     : std::nullopt;
}

std::optional<PassRow> first_pass_from(const SessionReader& reader, std::int64_t time_ns) {
  const auto start = sequence_at(reader, time_ns);
  for (PassRow& pass : reader.passes()) {
    if (start && pass.first_sample >= *start) {
      return std::move(pass);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<DefinitionVersion> definition_versions(const SessionReader& reader) {
  std::vector<DefinitionVersion> versions{{reader.info().definition}};
  for (const EventRow& event : reader.events()) {
    if (event.kind == kNewDefinition) {
      versions.push_back({event.text, event.time_ns});
    }
  }
  for (DefinitionVersion& version : versions) {
    version.first = first_pass_from(reader, version.time_ns);
  }
  return versions;
}

const std::string& newest_definition(const SessionInfo& info, const std::vector<EventRow>& events) {
  const auto newest = std::find_if(events.rbegin(), events.rend(), [](const EventRow& event) {
    return event.kind == kNewDefinition;
  });
  return newest == events.rend() ? info.definition : newest->text;
}

}  // namespace haptrial::record
