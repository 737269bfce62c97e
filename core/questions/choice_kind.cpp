#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"
#include "core/questions/question_kinds.h"

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

/// One of several answers, by its number or by the arrow keys.
class ChoiceKind : public QuestionKind {
 public:
  std::string word() const override { return "choice"; }
  QuestionTraits traits() const noexcept override { return {}; }
  std::string key() const override { return "choices"; }

  void read(Table& table, Question& question) const override {
    std::vector<Table> choices = table.tables(key());
    if (choices.size() < 2 || choices.size() > kMostChoices) {
      table.reject(key(), fmt::format("a list of {}", choices.size()),
                   fmt::format("2 to {} choices", kMostChoices));
    }
    std::set<std::string> values;
    for (Table& each : choices) {
      Choice choice = choice_schema().read(each);
      if (!values.insert(choice.value).second) {
        each.reject("value", fmt::format("\"{}\"", choice.value),
                    "a value that no other choice has");
      }
      question.choices.push_back(std::move(choice));
    }
  }

  /// Trials state the keys of each choice.
  std::vector<int> heard_keys(const Question&) const override { return {}; }

  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override {
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

  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override {
    return draft.chosen >= 0 && draft.chosen < count_of(question);
  }

  Answer answer(const Question& question, const AnswerDraft& draft) const override {
    const Choice& choice = question.choices[static_cast<std::size_t>(draft.chosen)];
    return {choice.number, choice.value};
  }

  AnswerDraft draft_of(const Question& question, const Answer& answer) const override {
    AnswerDraft draft;
    const auto found = std::ranges::find(question.choices, answer.text, &Choice::value);
    draft.chosen =
        found == question.choices.end() ? -1 : static_cast<int>(found - question.choices.begin());
    return draft;
  }

  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    const auto number = number_in(words);
    const int count = count_of(question);
    if (!number || *number != std::floor(*number) || *number < 1.0 || *number > count) {
      return fmt::format("the answer is '{}'; allowed: the number of a choice, 1 to {}",
                         cut_text(words, 40), count);
    }
    draft.chosen = static_cast<int>(*number) - 1;
    return "";
  }

  std::string written(const Question&, const AnswerDraft& draft) const override {
    return draft.chosen < 0 ? "" : fmt::format("{}", draft.chosen + 1);
  }

  AnswerView view(const Question& question, const AnswerDraft& draft) const override {
    AnswerView view;
    view.chosen = draft.chosen;
    for (std::size_t i = 0; i < question.choices.size(); ++i) {
      view.choices.push_back(fmt::format("{}   {}", i + 1, question.choices[i].label));
    }
    return view;
  }

  std::string hint(const Question&, const HintTexts& texts) const override { return texts.choose; }

  void simulate(const Question& question, std::optional<double>, RandomStream& random,
                AnswerDraft& draft) const noexcept override {
    draft.chosen = static_cast<int>(random.below(question.choices.size()));
  }
};

struct ConsentWords {
  std::string accept{"I agree to take part"};
  std::string decline{"I do not agree"};
};

const Schema<ConsentWords>& consent_schema() {
  using W = ConsentWords;
  static const auto schema =
      Schema<W>()
          .shown_text("accept", &W::accept, "Words of the choice of people who take part")
          .shown_text("decline", &W::decline,
                      "Words of the choice of people who do not take part, "
                      "which ends the session");
  return schema;
}

/// Consent to take part, which is accepted or declined: choices 0 and 1. An experimenter agrees in
/// the participant's place only with a reason, "1: paper form signed".
class ConsentKind final : public ChoiceKind {
 public:
  std::string word() const override { return "consent"; }
  QuestionTraits traits() const noexcept override {
    return {.consents = true, .scored = false, .in_trials = false};
  }
  std::string key() const override { return ""; }

  void read(Table& table, Question& question) const override {
    title_schema().read(table, question);
    reading_schema().read(table, question);
    const ConsentWords words = consent_schema().read(table);
    question.choices = {{"accepted", words.accept, 1.0}, {"declined", words.decline, 0.0}};
  }

  Answer answer(const Question& question, const AnswerDraft& draft) const override {
    Answer answer = ChoiceKind::answer(question, draft);
    answer.reason = draft.typed.view();
    return answer;
  }

  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    const std::size_t colon = std::min(words.find(':'), words.size());
    const std::size_t reason = words.find_first_not_of(": ", colon);
    const std::string problem = ChoiceKind::parse(question, words.substr(0, colon), draft);
    const bool agreed = problem.empty() && draft.chosen == 0;
    if (agreed && reason == std::string::npos) {
      return "the participant consents in the window; if a paper form is signed, answer with the "
             "number and the reason, as in \"1: paper form signed\"";
    }
    if (agreed) {
      draft.typed.set(words.substr(reason));
    }
    return problem;
  }

  void simulate(const Question&, std::optional<double>, RandomStream&,
                AnswerDraft& draft) const noexcept override {
    draft.chosen = 0;
  }
};

}  // namespace

const QuestionKind& choice_kind() {
  static const ChoiceKind kind;
  return kind;
}

const QuestionKind& consent_kind() {
  static const ConsentKind kind;
  return kind;
}

}  // namespace haptrial::questions
