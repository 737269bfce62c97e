#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"
#include "core/questions/question_kinds.h"

namespace haptrial::questions {
namespace {

const Schema<Question>& ends_schema() {
  static const auto schema =
      Schema<Question>()
          .shown_text("low", &Question::low_end, "Words at the lowest value of a scale")
          .required()
          .shown_text("high", &Question::high_end, "Words at the highest value of a scale")
          .required();
  return schema;
}

const Schema<Question>& scale_schema() {
  static const auto schema =
      steps_schema("scale",
                   "Lowest and highest value of a scale on which a mark is moved; after a trial, "
                   "without `step` and `ends`, lowest and highest digit",
                   "choices, a number or words")
          .custom("ends", "Words at both ends of a scale",
                  [](Table& table, const std::string& key, Question& question) {
                    Table ends = table.table(key);
                    ends_schema().read(ends, question);
                  })
          .otherwise("none");
  return schema;
}

/// The mark goes to the number that the digits so far make, if the scale has it.
bool type_mark(const Question& question, char digit, AnswerDraft& draft) noexcept {
  const auto step_of = [&] { return step_near(question, *number_in(draft.typed.view())); };
  constexpr std::size_t kMostDigits = 12;
  if (draft.typed.view().size() >= kMostDigits) {
    draft.typed.clear();
  }
  draft.typed.append(static_cast<char32_t>(digit));
  if (step_of() > steps_of(question)) {
    draft.typed.clear();
    draft.typed.append(static_cast<char32_t>(digit));
  }
  const int step = step_of();
  if (step < 0 || step > steps_of(question)) {
    return false;
  }
  draft.chosen = step;
  return true;
}

/// A mark between two ends, moved in steps by the arrow keys or set by typing a number. Where it
/// begins is no answer: it has no place until it is moved.
class ScaleKind final : public QuestionKind {
 public:
  std::string word() const override { return "scale"; }
  QuestionTraits traits() const noexcept override { return {.marks = true}; }
  std::string key() const override { return "scale"; }

  void read(Table& table, Question& question) const override {
    scale_schema().read(table, question);
  }

  std::vector<int> heard_keys(const Question&) const override {
    return digits_and({KeyPress::kLeft, KeyPress::kRight, KeyPress::kUp, KeyPress::kDown});
  }

  /// The mark appears in the middle.
  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override {
    if (key.key >= '0' && key.key <= '9') {
      return type_mark(question, static_cast<char>(key.key), draft) ? KeyEffect::kChanged
                                                                    : KeyEffect::kNothing;
    }
    draft.typed.clear();
    const int before = draft.chosen;
    const int move = key.key == KeyPress::kRight || key.key == KeyPress::kUp    ? 1
                     : key.key == KeyPress::kLeft || key.key == KeyPress::kDown ? -1
                                                                                : 0;
    if (move != 0) {
      const int steps = steps_of(question);
      draft.chosen = std::clamp((before < 0 ? steps / 2 : before) + move, 0, steps);
    }
    return draft.chosen != before ? KeyEffect::kChanged : KeyEffect::kNothing;
  }

  void move_mark(const Question& question, double share,
                 AnswerDraft& draft) const noexcept override {
    draft.typed.clear();
    draft.chosen = static_cast<int>(std::lround(share * steps_of(question)));
  }

  double share_of_mark(const Question& question, const AnswerDraft& draft) const noexcept override {
    return static_cast<double>(draft.chosen) / steps_of(question);
  }

  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override {
    return draft.chosen >= 0 && draft.chosen <= steps_of(question);
  }

  Answer answer(const Question& question, const AnswerDraft& draft) const override {
    return {value_of_step(question, draft.chosen), ""};
  }

  AnswerDraft draft_of(const Question& question, const Answer& answer) const override {
    AnswerDraft draft;
    draft.chosen = step_near(question, answer.value);
    return draft;
  }

  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    const auto number = number_in(words);
    if (!number || *number < question.low || *number > question.high) {
      return fmt::format("the answer is '{}'; allowed: a number from {:g} to {:g}",
                         cut_text(words, 40), question.low, question.high);
    }
    const double steps = (*number - question.low) / question.step;
    if (std::abs(steps - std::round(steps)) > 1e-6) {
      return fmt::format("the answer is {:g}; allowed: {:g} to {:g} in steps of {:g}", *number,
                         question.low, question.high, question.step);
    }
    draft.chosen = step_near(question, *number);
    return "";
  }

  std::string written(const Question& question, const AnswerDraft& draft) const override {
    return draft.chosen < 0 ? "" : fmt::format("{:g}", value_of_step(question, draft.chosen));
  }

  AnswerView view(const Question& question, const AnswerDraft& draft) const override {
    AnswerView view;
    const int steps = steps_of(question);
    view.chosen = draft.chosen;
    view.scale = ScaleView{steps, question.low_end, question.high_end};
    if (question.low_end.empty()) {
      view.scale->low_end = fmt::format("{:g}", question.low);
      view.scale->high_end = fmt::format("{:g}", question.high);
    }
    for (int step = 0; step <= steps; ++step) {
      view.scale->numbers.push_back(fmt::format("{:g}", value_of_step(question, step)));
    }
    return view;
  }

  std::string hint(const Question&, const HintTexts& texts) const override {
    return texts.move_mark;
  }

  /// Without anything felt, around the middle.
  void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                AnswerDraft& draft) const noexcept override {
    constexpr double kSpread = 0.2;  // of the scale
    const int steps = steps_of(question);
    draft.chosen = felt ? std::clamp(step_near(question, *felt), 0, steps)
                        : static_cast<int>(std::round(
                              steps * std::clamp(0.5 + kSpread * random.normal(), 0.0, 1.0)));
  }
};

}  // namespace

const QuestionKind& scale_kind() {
  static const ScaleKind kind;
  return kind;
}

}  // namespace haptrial::questions
