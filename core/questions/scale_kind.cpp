#include "core/questions/scale_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"

namespace haptrial::questions {
namespace {

constexpr double kMostSteps = 200.0;

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

}  // namespace

const QuestionKind& scale_kind() {
  static const ScaleKind kind;
  return kind;
}

int steps_of(const Question& question) noexcept {
  return static_cast<int>(std::lround((question.high - question.low) / question.step));
}

double value_of_step(const Question& question, int step) noexcept {
  return question.low + question.step * step;
}

int step_near(const Question& question, double value) noexcept {
  constexpr double kFar = 1e9;
  return static_cast<int>(
      std::lround(std::clamp((value - question.low) / question.step, -kFar, kFar)));
}

Schema<Question> steps_schema(std::string key, std::string description, std::string otherwise) {
  Schema<Question> schema;
  schema.custom(key, std::move(description), read_range)
      .otherwise(std::move(otherwise))
      .number("step", &Question::step, {0.0, 1e9, true}, "",
              "Distance between neighbouring values of a scale")
      .otherwise("1; after a trial, without `ends`, digits are typed")
      .check([key](Table& table, Question& question) {
        const double steps = (question.high - question.low) / question.step;
        if (std::abs(steps - std::round(steps)) > 1e-9 * steps || steps > kMostSteps) {
          table.reject(table.has("step") ? "step" : key, fmt::format("{} steps long", steps),
                       fmt::format("a whole number of steps, at most {}", kMostSteps));
        }
      });
  return schema;
}

void ScaleKind::read(Table& table, Question& question) const {
  scale_schema().read(table, question);
}

std::vector<int> ScaleKind::heard_keys(const Question&) const {
  return digits_and({KeyPress::kLeft, KeyPress::kRight, KeyPress::kUp, KeyPress::kDown});
}

/// The mark appears in the middle.
KeyEffect ScaleKind::press(const Question& question, const KeyPress& key,
                           AnswerDraft& draft) const noexcept {
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

void ScaleKind::move_mark(const Question& question, double share,
                          AnswerDraft& draft) const noexcept {
  draft.typed.clear();
  draft.chosen = static_cast<int>(std::lround(share * steps_of(question)));
}

double ScaleKind::share_of_mark(const Question& question, const AnswerDraft& draft) const noexcept {
  return static_cast<double>(draft.chosen) / steps_of(question);
}

bool ScaleKind::is_complete(const Question& question, const AnswerDraft& draft) const noexcept {
  return draft.chosen >= 0 && draft.chosen <= steps_of(question);
}

Answer ScaleKind::answer(const Question& question, const AnswerDraft& draft) const {
  return {value_of_step(question, draft.chosen), ""};
}

AnswerDraft ScaleKind::draft_of(const Question& question, const Answer& answer) const {
  AnswerDraft draft;
  draft.chosen = step_near(question, answer.value);
  return draft;
}

std::string ScaleKind::parse(const Question& question, const std::string& words,
                             AnswerDraft& draft) const {
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

std::string ScaleKind::written(const Question& question, const AnswerDraft& draft) const {
  return draft.chosen < 0 ? "" : fmt::format("{:g}", value_of_step(question, draft.chosen));
}

AnswerView ScaleKind::view(const Question& question, const AnswerDraft& draft) const {
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

std::string ScaleKind::hint(const Question&, const HintTexts& texts) const {
  return texts.move_mark;
}

/// Without anything felt, around the middle.
void ScaleKind::simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                         AnswerDraft& draft) const noexcept {
  constexpr double kSpread = 0.2;  // of the scale
  const int steps = steps_of(question);
  draft.chosen = felt ? std::clamp(step_near(question, *felt), 0, steps)
                      : static_cast<int>(std::round(
                            steps * std::clamp(0.5 + kSpread * random.normal(), 0.0, 1.0)));
}

}  // namespace haptrial::questions
