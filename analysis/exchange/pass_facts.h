#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/exchange/columns.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::exchange {

/// The variables, the levels of procedures and the answers of each pass of a session. The columns
/// depend on the definition.
struct PassFacts {
  std::vector<ColumnDoc> columns;                         // in the order in which they first occur
  std::vector<std::map<std::string, std::string>> cells;  // (passes) text by column
};

/// The first question's reaction time has the column "response_time", as BIDS names it. A name that
/// the table of passes has already gets "_value" behind it, and so does a variable with the name of
/// another column; a question with the name of a variable gets "_answer".
PassFacts pass_facts(const record::SessionReader& reader);

/// Adds the columns that are not there, by name.
void merge_columns(const std::vector<ColumnDoc>& more, std::vector<ColumnDoc>& columns);

/// The status of each pass in a word. A pass whose answer was taken back is aborted; one with an
/// answer that came too early or too late, so that the trial was presented again, is out of time.
std::vector<const char*> pass_statuses(const record::SessionReader& reader);
/// These words and what they mean.
const Levels& status_levels();

/// When a pass was, by the session's clock.
struct PassSpan {
  double onset{0.0};     // of its first tick, since the first tick of the session [s]
  double duration{0.0};  // to the end of its last tick; 0: it has none [s]
};

/// The spans of all passes. A loop that was suspended shifts the clock against the numbers of the
/// ticks, so that these do not tell the time. A session without samples has that of the numbers.
/// @throws InputError when the file is damaged.
std::vector<PassSpan> pass_spans(const record::SessionReader& reader);

}  // namespace haptrial::exchange
