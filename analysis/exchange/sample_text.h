#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/exchange/columns.h"
#include "analysis/files/delimited.h"
#include "analysis/files/gzip_file.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {

class SessionReader;
}

namespace haptrial::record {

class SessionReader;
class TableDescription;
}  // namespace haptrial::record

namespace haptrial::exchange {

class Counter;
class GzipFile;

/// The part of a pass in which the trajectory ran (Stage::kRun), in sequence numbers.
struct RunSpan {
  std::uint64_t first{0};
  std::uint64_t ticks{0};  // from first to last, both included; 0 where it never ran
};

/// Shift of the clock from this sample on, against the sequence numbers: after a suspension, or
/// where a session was resumed.
struct ClockShift {
  std::int64_t time_ns{0};
  std::int64_t by_ns{0};
};

struct WrittenSamples {
  std::uint64_t first_sequence{0};
  std::uint64_t ticks{0};          // from the first sequence number to the last
  std::uint64_t missing{0};        // ticks among them without a row in the session file
  std::vector<RunSpan> runs;       // (passes)
  std::vector<ClockShift> shifts;  // of 2 ms or more, in order of time
  std::size_t other_devices{0};    // after the first, each with columns of its own

  /// Time, on an even clock, of the tick that the clock read at this time [ns].
  std::int64_t even_time(std::int64_t time_ns) const;
};

/// Writes /samples as text, a piece at a time: memory does not grow with the session. Columns as
/// sample_docs() has them for the session's devices; nothing stands where a further device has no
/// row for a tick. kTsv: no heading and no sequence numbers, and a row of "n/a" for every
/// missing tick, so that row k is tick first_sequence + k. kCsv: with heading, without such rows.
/// @throws InputError when the file is damaged; RunError when the disk is full or `counter` stops.
WrittenSamples write_samples(const record::SessionReader& reader, Delimited kind, GzipFile& file,
                             Counter& counter);

/// Rows of /stimuli as text with heading, columns as stimulus_docs() has them.
std::string stimulus_text(std::span<const record::StimulusRow> rows, Delimited kind);

/// All columns of a table of the session file.
std::vector<ColumnDoc> docs_of(const record::TableDescription& table);

/// Writes the samples of a channel, a row each with all columns of its table.
/// @param table  of the channel, one of the reader's
/// @param ticks  nothing: a heading and the columns; else no heading, and before the columns the
///               time of each sample on the even clock of these ticks
/// @throws InputError when the file is damaged, RunError when the disk is full
void write_channel(const record::SessionReader& reader, const record::TableDescription& table,
                   Delimited kind, const WrittenSamples* ticks, GzipFile& file);

/// Incidents of the channels as events, such as "channel_lost" with "grip: no data come any more".
/// @param messages  whether texts that the channels gave are among them
std::vector<record::EventRow> channel_events(const record::SessionReader& reader, bool messages);

}  // namespace haptrial::exchange
