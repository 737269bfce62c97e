#include "protocols/psychophysics/sequence/scripted_decisions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/questions/question_kind.h"

namespace haptrial::protocols {
namespace {

using Line = nlohmann::ordered_json;  // keys in their order

/// The variables of each interval by name.
Line stimulus_of(std::span<const record::VariableRow> variables, std::size_t intervals) {
  Line all = Line::array();
  for (std::size_t interval = 1; interval <= intervals; ++interval) {
    Line own = Line::object();
    for (const record::VariableRow& row : variables) {
      if (row.interval == 0 || static_cast<std::size_t>(row.interval) == interval) {
        own[row.name] = row.word.empty() ? Line(row.value) : Line(row.word);
      }
    }
    all.push_back(std::move(own));
  }
  return all;
}

void add_allowed(Line& line, const TrialQuestion& question) {
  if (question.has_choices()) {
    line["choices"] = Line::array();
    for (const questions::Choice& choice : question.choices) {
      line["choices"].push_back(choice.value);
    }
    return;
  }
  line["kind"] = question.kind->word();
  if (question.is_number()) {
    line["low"] = question.low;
    line["high"] = question.high;
  }
}

Line written(const LeftDecision::Answer& answer, const TrialQuestion& question) {
  const questions::Answer given = given_answer(question, answer.choice, answer.draft);
  return question.has_choices() || std::isnan(given.value) ? Line(given.text) : Line(given.value);
}

std::string allowed_words(const TrialQuestion& question) {
  if (!question.has_choices()) {
    return question.is_number() ? fmt::format("a number from {} to {}", question.low, question.high)
                                : fmt::format("a text of at most {} bytes", question.most_bytes);
  }
  std::vector<std::string> values;
  for (const questions::Choice& choice : question.choices) {
    values.push_back(Line(choice.value).dump());
  }
  return fmt::format("{}", fmt::join(values, ", "));
}

/// Nothing for an answer that the question does not allow.
std::optional<LeftDecision::Answer> answer_in(const Line& said, const TrialQuestion& question,
                                              LeftDecision::Answer answer) {
  if (said.is_null()) {
    return answer;
  }
  const std::string value = said.is_string() ? said.get<std::string>() : said.dump();
  if (!question.has_choices()) {
    answer.draft = {};
    const bool form = said.is_number() == question.is_number();
    const bool good = form && question.kind->parse(question, value, answer.draft).empty();
    return good ? std::optional(answer) : std::nullopt;
  }
  const auto found = std::ranges::find(question.choices, value, &questions::Choice::value);
  answer.choice = static_cast<int>(found - question.choices.begin());
  return found != question.choices.end() ? std::optional(answer) : std::nullopt;
}

/// A decision's own seed, of 53 bits: numbers of every language hold it.
std::uint64_t seed_of(std::uint64_t seed, const TrialToDecide& trial,
                      const TrialQuestion& question) {
  return derived_seed(seed, fmt::format("decision {}{} {}", trial.practice ? "practice " : "",
                                        trial.trial, question.name)) >>
         11;
}

}  // namespace

struct ScriptedDecisions::History {
  Line trials = Line::array();
};

ScriptedDecisions::ScriptedDecisions(const ScriptPlan& plan, std::string subject,
                                     std::uint64_t seed, std::function<void()> pulse)
    : plan_(plan),
      subject_(std::move(subject)),
      seed_(seed),
      pulse_(std::move(pulse)),
      process_(plan.file, plan.deadline, "answer"),
      history_(std::make_unique<History>()) {}

ScriptedDecisions::~ScriptedDecisions() = default;

std::string ScriptedDecisions::line_of(const TrialToDecide& trial, const TrialQuestion& question,
                                       const LeftDecision::DecisionRequest& asked) const {
  Line line{{"subject", subject_},
            {"trial", trial.trial},
            {"practice", trial.practice},
            {"question", question.name}};
  add_allowed(line, question);
  line["percepts"] = std::span(asked.percepts).first(asked.intervals);
  line["stimulus"] = stimulus_of(trial.variables, asked.intervals);
  line["proposed"] = written(asked.proposed, question);
  line["reaction_time"] = asked.proposed.reaction;
  line["seed"] = seed_of(seed_, trial, question);
  line["history"] = history_->trials;
  return line.dump();
}

LeftDecision::Answer ScriptedDecisions::decide(const TrialToDecide& trial,
                                               const TrialQuestion& question,
                                               const LeftDecision::DecisionRequest& asked) {
  const auto refuse = [&](const std::string& why) {
    return InputError(fmt::format("observer.script: {}trial {} of {}: {}: {}",
                                  trial.practice ? "practice " : "", trial.trial, subject_,
                                  plan_.file.filename().string(), why));
  };
  const ScriptProcess::Reply reply = process_.ask(line_of(trial, question, asked), pulse_);
  if (reply.line.empty()) {
    throw refuse(reply.why_not);
  }
  const Line said = Line::parse(reply.line);
  std::optional<LeftDecision::Answer> answer = answer_in(said["answer"], question, asked.proposed);
  if (!answer) {
    throw refuse(fmt::format("its answer was {}; allowed: {}, or null for the participant's own",
                             said["answer"].dump(), allowed_words(question)));
  }
  if (said.contains("reaction_time")) {
    constexpr double kLongest = 600.0;  // [s]
    const Line& time = said["reaction_time"];
    answer->reaction = time.is_number() ? time.get<double>() : -1.0;
    if (!(answer->reaction >= 0.0 && answer->reaction <= kLongest)) {
      throw refuse(
          fmt::format("its reaction_time was {}; allowed: 0 to {:g} s", time.dump(), kLongest));
    }
  }
  return *answer;
}

void ScriptedDecisions::told(int trial, bool practice,
                             std::span<const record::ResponseRow> responses) {
  Line answers = Line::object();
  for (const record::ResponseRow& row : responses) {
    answers[row.question] = row.text.empty() ? Line(row.value) : Line(row.text);
  }
  history_->trials.push_back({{"trial", trial}, {"practice", practice}, {"answers", answers}});
}

}  // namespace haptrial::protocols
