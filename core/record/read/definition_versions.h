#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

class SessionReader;

/// Kinds of the two events of a session that was resumed with a changed definition: the keys, and
/// the whole new text.
inline constexpr const char* kDefinitionChanged = "definition_changed";
inline constexpr const char* kNewDefinition = "definition";

/// A definition that a session was recorded with, or a part of one.
struct DefinitionVersion {
  std::string text;
  std::int64_t time_ns{0};         // from when, on the clock of /samples; 0: the start [ns]
  std::optional<PassRow> first{};  // the first pass with it; none if no pass was
};

/// The definitions of a session in the order in which they held: that of its start, then those that
/// it was resumed with. @throws InputError as the reader does
std::vector<DefinitionVersion> definition_versions(const SessionReader& reader);

/// The last of them, from the start's definition and the events so far.
const std::string& newest_definition(const SessionInfo& info, const std::vector<EventRow>& events);

}  // namespace haptrial::record
