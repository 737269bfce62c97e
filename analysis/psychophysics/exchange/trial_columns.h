#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptrial::analysis {

class CsvTable;
}

namespace haptrial::analysis::trials {

/// The program that wrote a table of trials, as its columns show.
enum class TableOrigin { kPsychoPy, kJsPsych, kPlain };

const char* name_of(TableOrigin origin);

/// A column whose values become those of a variable of the definition.
struct FactorColumn {
  std::string variable;
  std::string column;
};

/// A row is a trial only if its field in this column is `value`.
struct RowFilter {
  std::string column;
  std::optional<std::string> value;  // nothing: any but a missing one
};

/// The columns of a table that say what a trial was. A name that is empty: the table has none.
struct TrialColumns {
  TableOrigin origin{TableOrigin::kPlain};
  std::string participant;  // empty: the table's file is of one participant, and named so
  std::string session;      // number of the participant's session, from 1
  std::string block;        // number of the block within the session, from 1
  std::string track;        // the procedure's track that set the level
  std::string level;        // number: the level of the stimulus
  std::string answer;       // what was answered
  std::string correct;      // whether the answer was right
  std::string time;         // reaction time, in units of `time_unit`
  std::string rating;       // a second answer: how sure somebody is
  std::string probe;        // which catch trial it is; nothing or "no": none
  std::string outcome;      // what a procedure learnt from the answer
  std::string simulated;    // whether the participant is a program
  double time_unit{0.0};    // [s]; 0: not known
  std::vector<FactorColumn> factors;
  std::vector<RowFilter> filters;

  /// Roles by the names that options and sentences have for them.
  static const std::vector<std::pair<const char*, std::string TrialColumns::*>>& roles();
};

/// The columns that a table has under the names that PsychoPy, jsPsych and most people give them.
/// Where several columns could have a role, none of them gets it. Factors are never guessed.
TrialColumns guess_columns(const CsvTable& table);

/// Gives a role another column than the guessed one, as "answer=key_resp.keys".
/// @param setting  ROLE=COLUMN; without a column the role is taken away
/// @throws InputError for another role, naming the option
void set_column(std::string_view setting, TrialColumns& columns);

/// Adds a factor: NAME=COLUMN, or a column that has the factor's name.
/// @throws InputError for a name that a definition cannot have
void add_factor(std::string_view setting, TrialColumns& columns);

/// Adds a filter: COLUMN=VALUE. @throws InputError without "="
void add_filter(std::string_view setting, TrialColumns& columns);

/// A text with its ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The finite number that a whole text is; nothing: it is none.
std::optional<double> number_in(std::string_view text);

/// Whether a field stands for no value: "", "null", "None", "NA" and the like.
bool is_missing(std::string_view text);

/// The loops of a table of PsychoPy, each a column LOOP.thisN.
std::vector<std::string> loops_of(const CsvTable& table);
inline constexpr std::string_view kLoopNumber = ".thisN";

/// The entry of a list of one, ['left'] or ["left"], as PsychoPy and jsPsych write some answers;
/// any other text as it is.
std::string_view unwrapped(std::string_view text);

}  // namespace haptrial::analysis::trials
