#pragma once

#include <string>

namespace haptrial::record {

class SessionReader;

/// Kind of the event of a session whose trials another program presented; its text names the file.
inline constexpr const char* kImportedEvent = "imported";

/// The table that a session was imported from, as its event says; empty: haptrial recorded it.
/// An imported session has no samples, and the numbers of its ticks count trials.
std::string imported_from(const SessionReader& reader);

}  // namespace haptrial::record
