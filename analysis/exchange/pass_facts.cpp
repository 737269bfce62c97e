#include "analysis/exchange/pass_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ranges>
#include <set>

#include "core/record/read/marked_trials.h"
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

  void add(std::int32_t pass, ColumnDoc column, const std::string& text) {
    if (pass >= 0 && static_cast<std::size_t>(pass) < facts_.cells.size()) {
      tell_apart(column);
      merge_columns({column}, facts_.columns);
      facts_.cells[static_cast<std::size_t>(pass)][column.name] = text;
    }
  }
  void add(std::int32_t pass, const ColumnDoc& column, double number) {
    add(pass, column, std::isfinite(number) ? fmt::format("{}", number) : std::string());
  }
  /// @param behind  goes behind a name that another column has already, "_answer"
  void begin(const char* behind) { behind_ = behind; }
  PassFacts take() { return std::move(facts_); }

 private:
  /// A question may have the name of a variable, and a variable that of a column here.
  void tell_apart(ColumnDoc& column) const {
    const auto is_another = [&column](const ColumnDoc& each) {
      return each.name == column.name && each.description != column.description;
    };
    while (std::ranges::any_of(facts_.columns, is_another)) {
      column.name += behind_;
    }
  }

  PassFacts facts_;
  std::string behind_;
};

/// Names that stand in columns of their own, or are those of the pass itself.
bool is_known(const std::string& name) {
  return name == "trial" || name == "interval" || name == "session";
}

void add_variables(const record::SessionReader& reader, Collector& to) {
  to.begin("_value");
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
  to.begin("_level");
  for (const record::LevelRow& row : reader.rows<record::LevelRow>()) {
    to.add(row.pass, {"track", "", "the track that chose the level"}, row.track);
    to.add(row.pass,
           {row.variable + "_asked", "", fmt::format("{} that the track asked for", row.variable)},
           row.asked);
    to.add(row.pass, {"outcome", "", "what the track learnt from the answer"}, row.outcome);
  }
}

void add_answers(const record::SessionReader& reader, Collector& to) {
  to.begin("_answer");
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

namespace {

/// Times of single ticks on the session's clock.
class TickTimes {
 public:
  explicit TickTimes(const record::SessionReader& reader)
      : reader_(reader),
        rows_(reader.sample_count()),
        first_(rows_ > 0 ? sample_of(0).sequence : 0) {}

  /// A tick that the file lacks is as far after the last one before it as its number says. [ns]
  std::int64_t time_of(std::uint64_t sequence) const {
    if (rows_ == 0 || sequence < first_) {
      return length_of(sequence);
    }
    const record::Sample last = last_until(sequence);
    return last.time_ns + length_of(sequence - last.sequence);
  }
  /// Duration of a number of ticks [ns].
  std::int64_t length_of(std::uint64_t ticks) const {
    return std::llround(1e9 * static_cast<double>(ticks) / reader_.info().rate);
  }

 private:
  record::Sample sample_of(std::uint64_t row) const { return reader_.samples(row, 1).front(); }

  /// Without gaps it is in the row of its number.
  record::Sample last_until(std::uint64_t sequence) const {
    const std::uint64_t latest = std::min(sequence - first_, rows_ - 1);
    const record::Sample sample = sample_of(latest);
    if (sample.sequence <= sequence) {
      return sample;
    }
    const auto rows = std::views::iota(std::uint64_t{0}, latest);
    const auto after = std::ranges::partition_point(
        rows, [&](std::uint64_t row) { return sample_of(row).sequence <= sequence; });
    return sample_of(static_cast<std::uint64_t>(after - rows.begin()) - 1);
  }

  const record::SessionReader& reader_;
  std::uint64_t rows_;
  std::uint64_t first_;
};

}  // namespace

std::vector<const char*> pass_statuses(const record::SessionReader& reader) {
  const std::set<int> left_out = record::trials_left_out(reader);
  std::vector<const char*> statuses;
  for (const record::PassRow& pass : reader.passes()) {
    const bool marked = pass.status == record::PassStatus::kCompleted && !pass.practice &&
                        left_out.contains(pass.trial);
    statuses.push_back(marked ? "marked as bad" : record::name_of(pass.status));
  }
  for (const record::OutOfTimeRow& row : reader.rows<record::OutOfTimeRow>()) {
    const auto pass = static_cast<std::size_t>(row.pass);
    if (row.again && pass < statuses.size() && statuses[pass] != std::string_view("aborted")) {
      statuses[pass] = "out of time";
    }
  }
  return statuses;
}

const Levels& status_levels() {
  static const Levels levels{
      {"completed", "came to its end"},
      {"aborted", "was broken off, or its answer was taken back"},
      {"damaged", "came to its end, but some of its samples were lost with the file"},
      {"marked as bad",
       "came to its end; the experimenter marked its trial, and the study leaves "
       "such trials out"},
      {"out of time", "an answer came too early or too late; the trial was presented again"}};
  return levels;
}

std::vector<PassSpan> pass_spans(const record::SessionReader& reader) {
  const TickTimes times(reader);
  std::vector<PassSpan> spans;
  for (const record::PassRow& pass : reader.passes()) {
    const std::int64_t begin = times.time_of(pass.first_sample);
    const std::int64_t end = pass.last_sample < pass.first_sample
                                 ? begin
                                 : times.time_of(pass.last_sample) + times.length_of(1);
    spans.push_back({static_cast<double>(begin) / 1e9, static_cast<double>(end - begin) / 1e9});
  }
  return spans;
}

}  // namespace haptrial::exchange
