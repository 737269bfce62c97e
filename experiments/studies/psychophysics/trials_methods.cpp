#include "experiments/studies/psychophysics/trials_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/preview/preview.h"
#include "experiments/preview/trials_parts.h"

namespace haptrial::experiments {
namespace {

using analysis::Document;
using protocols::GivenValue;
using protocols::StudiedDefinition;
using protocols::TrialQuestion;

std::string words_of(const std::vector<GivenValue>& values) {
  std::vector<std::string> words;
  for (const GivenValue& value : values) {
    words.push_back(fmt::format("{} = {}", value.name, value.formula));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// A value of a definition as it stands there; empty if it is a table.
std::string stated_value(const protocols::Definition& d, const std::string& table,
                         const std::string& name, const std::string& key) {
  Table root = d.root();
  Table own = root.table(table).table(name);
  if (const auto text = own.whole_text(key)) {
    return *text;
  }
  if (own.is_array(key)) {
    std::vector<std::string> all;
    for (const auto& row : own.rows(key, "")) {
      for (const NumberOrText& each : row) {
        all.push_back(each.number ? fmt::format("{:g}", *each.number) : each.text);
      }
    }
    return fmt::format("({})", fmt::join(all, ", "));
  }
  if (own.is_table(key)) {
    return "";
  }
  const double number = own.number(key, {}, "");
  try {
    root.check();
  } catch (const InputError&) {
    return fmt::format("{}", own.boolean(key));
  }
  return fmt::format("{:g}", number);
}

void add_fields(const StudiedDefinition& d, Document& document) {
  Table root = d.root();
  if (!root.has("fields")) {
    return;
  }
  std::vector<std::vector<std::string>> rows;
  Table fields = root.table("fields");
  for (const std::string& name : fields.keys_as_written()) {
    std::vector<std::string> parameters;
    std::string type;
    for (const std::string& key : fields.table(name).keys_as_written()) {
      const std::string value = stated_value(d, "fields", name, key);
      if (key == "type") {
        type = value;
      } else if (!value.empty()) {
        parameters.push_back(fmt::format("{} {}", key, value));
      }
    }
    rows.push_back({name, type, fmt::format("{}", fmt::join(parameters, ", "))});
  }
  document.table({"field", "law", "parameters (SI units; $ marks a value that trials vary)"}, rows);
}

std::string interval_words(const StudiedDefinition& d) {
  if (d.intervals.size() == 1) {
    return "Each trial had one interval.";
  }
  std::vector<std::string> words;
  for (const protocols::Interval& interval : d.intervals) {
    words.push_back(fmt::format("{} ({})", interval.name, words_of(interval.values)));
  }
  return fmt::format("Each trial had {} intervals, in {} order: {}.", d.intervals.size(),
                     d.random_intervals ? "random" : "fixed", fmt::join(words, ", "));
}

std::string factor_words(const StudiedDefinition& d) {
  std::vector<std::string> words;
  for (const protocols::Factor& factor : d.order.factors) {
    words.push_back(fmt::format("{} ({})", factor.name, fmt::join(factor.levels, ", ")));
  }
  return words.empty() ? "" : fmt::format(" Factors within blocks: {}.", fmt::join(words, "; "));
}

const char* words_of(protocols::Counterbalancing order) {
  using protocols::Counterbalancing;
  switch (order) {
    case Counterbalancing::kFixed:
      return "in this order for everybody";
    case Counterbalancing::kLatin:
      return "ordered by a cyclic Latin square";
    case Counterbalancing::kWilliams:
      return "ordered by a Williams design";
    case Counterbalancing::kFull:
      return "in every order equally often";
    default:
      return "in an order drawn for each participant";
  }
}

std::string block_words(const StudiedDefinition& d) {
  std::vector<std::string> words;
  for (const protocols::Block& block : d.order.blocks) {
    std::string each = block.name;
    each += block.trials > 0 ? fmt::format(" ({}{}", counted(block.trials, "trial", "trials"),
                                           block.practice ? " of practice" : "")
                             : std::string(" (until its procedures ended");
    each += block.right_in_a_row > 0
                ? fmt::format(", or until {} right answers in a row", block.right_in_a_row)
                : "";
    each += block.values.empty() ? "" : "; " + words_of(block.values);
    each += block.probe ? fmt::format("; probes {} in a share of {:g}: {}", block.probe->name,
                                      block.probe->share, words_of(block.probe->values))
                        : "";
    words.push_back(each + ")");
  }
  return fmt::format("Blocks, {}: {}.", words_of(d.order.order), fmt::join(words, ", "));
}

const char* words_of(protocols::TrialOrder order) {
  return order == protocols::TrialOrder::kCycles
             ? "Combinations of factors came each once before any came again"
         : order == protocols::TrialOrder::kShuffled
             ? "Combinations of factors came equally often, shuffled"
             : "Combinations of factors were drawn anew for each trial";
}

std::string order_words(const StudiedDefinition& d) {
  std::string words = block_words(d);
  words += d.order.factors.empty() ? "" : fmt::format(" {}.", words_of(d.order.trial_order));
  words += d.order.sessions > 1
               ? fmt::format(" Each participant came to {} sessions.", d.order.sessions)
               : "";
  words += d.order.break_after > 0
               ? fmt::format(" Breaks of {:g} s came after every {}.", d.order.break_duration,
                             counted(d.order.break_after, "trial", "trials"))
               : " There were no planned breaks.";
  return words;
}

std::string question_words(const TrialQuestion& q) {
  std::vector<std::string> labels;
  for (const auto& choice : q.choices) {
    labels.push_back(choice.label);
  }
  std::string words = fmt::format("Participants were asked \"{}\"", q.text);
  words += labels.empty() ? "." : fmt::format(" ({}).", fmt::join(labels, " / "));
  words += q.feedback == protocols::Feedback::kAlways ? " They were told whether they were right."
           : q.feedback == protocols::Feedback::kPractice
               ? " They were told in practice alone whether they were right."
               : " They were not told whether they were right.";
  words += q.timeout > 0.0 ? fmt::format(" An answer could take {:g} s.", q.timeout) : "";
  return words;
}

std::string track_words(const psychometric::Track& track) {
  const std::string unit = track.unit.empty() ? "" : " " + track.unit;
  return fmt::format(
      "{}: {} of {}, between {:g} and {:g}{}{}{}. {}", track.name, track.kind,
      fmt::join(track.variables(), " and "), track.low, track.high, unit,
      track.resolution > 0.0 ? fmt::format(", rounded to multiples of {:g}", track.resolution) : "",
      track.by.empty() ? ""
                       : fmt::format(", one for each level of {}", fmt::join(track.by, " and ")),
      track.rule);
}

}  // namespace

void add_trials_methods(const StudiedDefinition& d, std::uint64_t seed, Document& document) {
  constexpr int kMostParticipants = 200;
  document.heading("Stimuli and levels");
  document.paragraph(interval_words(d) + factor_words(d));
  add_fields(d, document);
  document.heading("Procedure");
  document.paragraph(order_words(d));
  document.paragraph("Stages of each interval, with the values of the first trial:");
  add_stage_table(protocols::previewed_trial(d, previewed_session(seed), 1), document);
  for (const TrialQuestion& question : d.questions) {
    document.paragraph(question_words(question));
  }
  for (const psychometric::Track& track : d.tracks) {
    document.paragraph(track_words(track));
  }
  if (d.script) {
    document.paragraph(fmt::format("A script of the experimenter's, {}, chose levels.",
                                   d.script->file.filename().string()));
  }
  add_planned(d, protocols::planned_trials(d, seed, kMostParticipants), document);
}

}  // namespace haptrial::experiments
