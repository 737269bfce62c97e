#pragma once

#include <vector>

#include "analysis/exchange/columns.h"
#include "analysis/exchange/sample_text.h"
#include "analysis/files/delimited.h"
#include "analysis/files/gzip_file.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {
class SessionReader;
class TableDescription;
}  // namespace haptrial::record

namespace haptrial::exchange {

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
