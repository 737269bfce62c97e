#include "analysis/exchange/pass_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::exchange {
namespace {

bool is_taken(const std::string& name) {
  constexpr std::array<std::string_view, 21> kTaken{
      "onset",         "duration",  "trial_type",   "stim_file", "pass",     "phase",
      "trial",         "block",     "repetition",   "attempt",   "practice", "status",
      "stimulus_seed", "run_onset", "run_duration", "event",     "text",     "subject",
      "session",       "simulated", "pilot"};
  return std::ranges::find(kTaken, name) != kTaken.end();
}

class Collector {
 public:
  explicit Collector(std::size_t passes) { facts_.cells.resize(passes); }

  void add(std::int32_t pass, const ColumnDoc& column, const std::string& text) {
    if (pass >= 0 && static_cast<std::size_t>(pass) < facts_.cells.size()) {
      merge_columns({column}, facts_.columns);
      facts_.cells[static_cast<std::size_t>(pass)][column.name] = text;
    }
  }
  void add(std::int32_t pass, const ColumnDoc& column, double number) {
    add(pass, column, std::isfinite(number) ? fmt::format("{}", number) : std::string());
  }
  PassFacts take() { return std::move(facts_); }

 private:
  PassFacts facts_;
};

/// Names that stand in columns of their own, or are those of the pass itself.
bool is_known(const std::string& name) {
  return name == "trial" || name == "interval" || name == "session";
}

void add_variables(const record::SessionReader& reader, Collector& to) {
  for (const record::VariableRow& row : reader.rows<record::VariableRow>()) {
    if (is_known(row.name)) {
      continue;
    }
    const std::string name = is_taken(row.name) ? row.name + "_value" : row.name;
    const ColumnDoc column =
        row.interval == 0
            ? ColumnDoc{name, "", fmt::format("the variable {} of the definition", row.name)}
            : ColumnDoc{
                  fmt::format("{}_{}", name, row.interval), "",
                  fmt::format("the variable {} of the definition, in interval {} of the trial",
                              row.name, row.interval)};
    row.word.empty() ? to.add(row.pass, column, row.value) : to.add(row.pass, column, row.word);
  }
}

void add_levels(const record::SessionReader& reader, Collector& to) {
  for (const record::LevelRow& row : reader.rows<record::LevelRow>()) {
    to.add(row.pass, {"track", "", "the track that chose the level"}, row.track);
    to.add(row.pass,
           {row.variable + "_asked", "", fmt::format("{} that the track asked for", row.variable)},
           row.asked);
    to.add(row.pass, {"outcome", "", "what the track learnt from the answer"}, row.outcome);
  }
}

void add_answers(const record::SessionReader& reader, Collector& to) {
  std::string first;
  for (const record::ResponseRow& row : reader.responses()) {
    first = first.empty() ? row.question : first;
    const std::string name = is_taken(row.question) ? row.question + "_value" : row.question;
    const ColumnDoc answer{name, "", fmt::format("the answer to the question {}", row.question)};
    row.text.empty() ? to.add(row.pass, answer, row.value) : to.add(row.pass, answer, row.text);
    if (row.correct >= 0) {
      to.add(row.pass,
             {name + "_correct",
              "",
              fmt::format("whether the answer to {} was right", row.question),
              {{"1", "right"}, {"0", "wrong"}}},
             static_cast<double>(row.correct));
    }
    to.add(row.pass,
           {row.question == first ? "response_time" : name + "_response_time", "s",
            fmt::format("reaction time of the answer to {}", row.question)},
           row.reaction_time);
  }
}

}  // namespace

void merge_columns(const std::vector<ColumnDoc>& more, std::vector<ColumnDoc>& columns) {
  for (const ColumnDoc& column : more) {
    if (std::ranges::find(columns, column.name, &ColumnDoc::name) == columns.end()) {
      columns.push_back(column);
    }
  }
}

PassFacts pass_facts(const record::SessionReader& reader) {
  Collector facts(reader.passes().size());
  add_levels(reader, facts);
  add_variables(reader, facts);
  add_answers(reader, facts);
  return facts.take();
}

}  // namespace haptrial::exchange
