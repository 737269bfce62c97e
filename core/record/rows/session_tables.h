#pragma once

#include <cstdint>
#include <vector>

#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

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

/// The tables of every session, each described once (docs/session-file.md). Those of a protocol
/// are its own.
const Table<Sample>& samples_table();
const Table<FrameRow>& frames_table();
const Table<PassRow>& trials_table();
const Table<EventPart>& events_table();
const Table<StimulusRow>& stimuli_table();
const Table<TimingRow>& timing_table();
const Table<EventPart>& attributes_table();  // row.kind is the name, row.text the value
const Table<RunRow>& runs_table();
const Table<BegunRow>& begun_table();

/// All of them, in the order in which they are created.
const TableList& session_tables();

}  // namespace haptrial::record
