#pragma once

#include <cstdint>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// A row of /events or /attributes: a text longer than its column goes on in the next rows, cut
/// between characters.
struct EventPart {
  EventRow row;
  std::int32_t part{0};
};
/// @throws std::invalid_argument for a kind above its column, or a NUL byte in kind or text.
std::vector<EventPart> event_parts(const EventRow& row);
/// Events from their rows, in order. @param parts  a part above 0 without its beginning stands
/// alone
std::vector<EventRow> joined_events(std::vector<EventPart> parts);

}  // namespace haptrial::record
