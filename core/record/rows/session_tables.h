#pragma once

#include "core/record/rows/event_parts.h"
#include "core/record/rows/run_types.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

namespace haptrial::record {

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
