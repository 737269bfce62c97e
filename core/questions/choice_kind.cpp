#include "core/questions/choice_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"

namespace haptrial::questions {
namespace {

constexpr std::size_t kMostChoices = 12;

const Schema<Choice>& choice_schema() {
  static const auto schema =
      Schema<Choice>()
          .text("value", &Choice::value, "Value of the choice in files")
          .required()
          .check([](Table& table, Choice& choice) {
            name_entry(table, "value", choice.value);
            choice.label = choice.value;
          })
          .shown_text("label", &Choice::label, "Words of the choice that participants read")
          .otherwise("the value")
          .number("number", &Choice::number, {}, "", "Number that a choice counts as in scores")
          .otherwise("none");
  return schema;
}

int count_of(const Question& question) noexcept {
  return static_cast<int>(question.choices.size());
}

}  // namespace

const QuestionKind& choice_kind() {
  static const ChoiceKind kind;
  return kind;
}

void ChoiceKind::read(Table& table, Question& question) const {
  std::vector<Table> choices = table.tables(key());
  if (choices.size() < 2 || choices.size() > kMostChoices) {
    table.reject(key(), fmt::format("a list of {}", choices.size()),
                 fmt::format("2 to {} choices", kMostChoices));
  }
  std::set<std::string> values;
  for (Table& each : choices) {
    Choice choice = choice_schema().read(each);
    if (!values.insert(choice.value).second) {
      each.reject("value", fmt::format("\"{}\"", choice.value), "a value that no other choice has");
    }
    question.choices.push_back(std::move(choice));
  }
}

/// Trials state the keys of each choice.
std::vector<int> ChoiceKind::heard_keys(const Question&) const { return {}; }

KeyEffect ChoiceKind::press(const Question& question, const KeyPress& key,
                            AnswerDraft& draft) const noexcept {
  const int before = draft.chosen;
  const int last = count_of(question) - 1;
  if (key.key >= '1' && key.key <= '9' && key.key - '1' <= last) {
    draft.chosen = key.key - '1';
  } else if (key.key == KeyPress::kDown || key.key == KeyPress::kRight) {
    draft.chosen = std::min(last, before + 1);
  } else if (key.key == KeyPress::kUp || key.key == KeyPress::kLeft) {
    draft.chosen = before < 0 ? last : std::max(0, before - 1);
  }
  return draft.chosen != before ? KeyEffect::kChanged : KeyEffect::kNothing;
}

bool ChoiceKind::is_complete(const Question& question, const AnswerDraft& draft) const noexcept {
  return draft.chosen >= 0 && draft.chosen < count_of(question);
}

Answer ChoiceKind::answer(const Question& question, const AnswerDraft& draft) const {
  const Choice& choice = question.choices[static_cast<std::size_t>(draft.chosen)];
  return {choice.number, choice.value};
}

AnswerDraft ChoiceKind::draft_of(const Question& question, const Answer& answer) const {
  AnswerDraft draft;
  const auto found = std::ranges::find(question.choices, answer.text, &Choice::value);
  draft.chosen =
      found == question.choices.end() ? -1 : static_cast<int>(found - question.choices.begin());
  return draft;
}

std::string ChoiceKind::parse(const Question& question, const std::string& words,
                              AnswerDraft& draft) const {
  const auto number = number_in(words);
  const int count = count_of(question);
  if (!number || *number != std::floor(*number) || *number < 1.0 || *number > count) {
    return fmt::format("the answer is '{}'; allowed: the number of a choice, 1 to {}",
                       cut_text(words, 40), count);
  }
  draft.chosen = static_cast<int>(*number) - 1;
  return "";
}

std::string ChoiceKind::written(const Question&, const AnswerDraft& draft) const {
  return draft.chosen < 0 ? "" : fmt::format("{}", draft.chosen + 1);
}

AnswerView ChoiceKind::view(const Question& question, const AnswerDraft& draft) const {
  AnswerView view;
  view.chosen = draft.chosen;
  for (std::size_t i = 0; i < question.choices.size(); ++i) {
    view.choices.push_back(fmt::format("{}   {}", i + 1, question.choices[i].label));
  }
  return view;
}

std::string ChoiceKind::hint(const Question&, const HintTexts& texts) const { return texts.choose; }

void ChoiceKind::simulate(const Question& question, std::optional<double>, RandomStream& random,
                          AnswerDraft& draft) const noexcept {
  draft.chosen = static_cast<int>(random.below(question.choices.size()));
}

}  // namespace haptrial::questions
