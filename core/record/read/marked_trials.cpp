#include "core/record/read/marked_trials.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/stated_words.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/session_tables.h"

namespace haptrial::record {
namespace {

/// Takes "trial 5: the reason" apart; nothing for a mark before the first trial.
std::optional<MarkedTrial> mark_of(const EventRow& event) {
  std::string_view rest = event.text;
  MarkedTrial mark;
  mark.time_ns = event.time_ns;
  constexpr std::string_view kPractice = "practice ", kTrial = "trial ";
  if (rest.starts_with(kPractice)) {
    mark.practice = true;
    rest.remove_prefix(kPractice.size());
  }
  if (!rest.starts_with(kTrial)) {
    return std::nullopt;
  }
  rest.remove_prefix(kTrial.size());
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), mark.trial);
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  if (error != std::errc() || !rest.starts_with(": ")) {
    return std::nullopt;
  }
  mark.reason = rest.substr(2);
  return mark;
}

/// The rule of the definition that the session keeps; none if it no longer reads.
MarkRule rule_of(const SessionReader& reader) {
  MarkRule rule;
  try {
    haptrial::Table root =
        haptrial::Table::parse(reader.info().definition, reader.info().definition_name);
    if (root.has("analysis")) {
      haptrial::Table analysis = root.table("analysis");
      mark_rule_schema().read(analysis, rule);
    }
  } catch (const InputError&) {
    return {};
  }
  return rule;
}

/// Counts the attempts of a trial that stand for themselves. A drilling that was broken off goes on
/// with the same bone in its next attempt, and `repetition` is the number of its bone.
std::int32_t attempt_of(const PassRow& pass) {
  return pass.phase == Phase("drilling") ? pass.repetition : pass.attempt;
}

/// Time of the session at which a pass began; that of its tick by the rate if no sample is there.
std::int64_t begin_of(const SessionReader& reader, const PassRow& pass) {
  const std::uint64_t row = row_of_tick(reader, samples_table(), pass.first_sample);
  if (row < reader.sample_count()) {
    return reader.integers(samples_table(), "time_ns", row, 1).front();
  }
  return static_cast<std::int64_t>(1e9 * static_cast<double>(pass.first_sample) /
                                   reader.info().rate);
}

/// Whether an attempt of the trial begins anew after the one that was marked.
bool is_presented_again(const SessionReader& reader, const std::vector<PassRow>& passes,
                        const MarkedTrial& mark) {
  std::optional<std::int32_t> marked;
  std::int32_t last = 0;
  for (const PassRow& pass : passes) {
    if (pass.trial != mark.trial || pass.practice != mark.practice) {
      continue;
    }
    last = std::max(last, attempt_of(pass));
    if (!marked || begin_of(reader, pass) <= mark.time_ns) {
      marked = attempt_of(pass);
    }
  }
  return marked && *marked < last;
}

}  // namespace

bool MarkRule::leaves_out(const std::string& reason) const {
  return exclude && (words.empty() || std::ranges::any_of(words, [&](const std::string& word) {
                       return has_stated_word(reason, word);
                     }));
}

const Schema<MarkRule>& mark_rule_schema() {
  static const auto schema =
      Schema<MarkRule>()
          .flag("exclude_marked", &MarkRule::exclude,
                "Whether trials that the experimenter marks as bad during the session are left out "
                "of the analysis; reports count them in any case")
          .texts("exclude_words", &MarkRule::words,
                 "Words, one of which the reason of such a mark must have for its trial to be left "
                 "out")
          .otherwise("any reason")
          .check([](haptrial::Table& table, MarkRule& rule) {
            if (!rule.words.empty() && !rule.exclude) {
              table.reject("exclude_words", "given without exclude_marked = true",
                           "exclude_marked = true beside it, or neither key");
            }
            if (std::ranges::find(rule.words, "") != rule.words.end()) {
              table.reject("exclude_words", "a list with an empty text", "a list of words");
            }
          });
  return schema;
}

std::vector<MarkedTrial> marked_trials(const SessionReader& reader) {
  std::vector<MarkedTrial> marks;
  for (const EventRow& event : reader.events()) {
    if (event.kind == "bad_trial") {
      if (auto mark = mark_of(event)) {
        marks.push_back(std::move(*mark));
      }
    }
  }
  if (marks.empty()) {
    return marks;
  }
  const MarkRule rule = rule_of(reader);
  const std::vector<PassRow> passes = reader.passes();
  for (MarkedTrial& mark : marks) {
    mark.presented_again = is_presented_again(reader, passes, mark);
    mark.left_out = !mark.practice && !mark.presented_again && rule.leaves_out(mark.reason);
  }
  return marks;
}

std::set<int> trials_left_out(const SessionReader& reader) {
  std::set<int> trials;
  for (const MarkedTrial& mark : marked_trials(reader)) {
    if (mark.left_out) {
      trials.insert(mark.trial);
    }
  }
  return trials;
}

}  // namespace haptrial::record
