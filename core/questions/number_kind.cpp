#include "core/questions/number_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"

namespace haptrial::questions {
namespace {

const Schema<Question>& number_schema() {
  static const auto schema =
      Schema<Question>()
          .custom("number", "Lowest and highest number that may be typed", read_range)
          .otherwise("choices, a scale or words");
  return schema;
}

/// The number of a draft that is complete; nothing of another.
std::optional<double> allowed_number(const Question& question, const AnswerDraft& draft) noexcept {
  const auto number = number_in(draft.typed.view());
  return number && *number >= question.low && *number <= question.high ? number : std::nullopt;
}

/// The shortest text that reads as exactly this number.
void type_number(double value, AnswerDraft& draft) noexcept {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  draft.typed.set({text.data(), static_cast<std::size_t>(written.ptr - text.data())});
}

}  // namespace

const QuestionKind& number_kind() {
  static const NumberKind kind;
  return kind;
}

void NumberKind::read(Table& table, Question& question) const {
  number_schema().read(table, question);
}

std::vector<int> NumberKind::heard_keys(const Question& question) const {
  return question.low < 0.0 ? digits_and({'.', KeyPress::kBackspace, '-'})
                            : digits_and({'.', KeyPress::kBackspace});
}

KeyEffect NumberKind::press(const Question&, const KeyPress& key,
                            AnswerDraft& draft) const noexcept {
  if (key.key == KeyPress::kBackspace) {
    return draft.typed.remove_last() ? KeyEffect::kChanged : KeyEffect::kNothing;
  }
  const bool allowed = key.character != 0 && key.character < 0x80 &&
                       std::string_view("0123456789.,-").find(static_cast<char>(key.character)) !=
                           std::string_view::npos;
  return allowed && draft.typed.append(key.character) ? KeyEffect::kChanged : KeyEffect::kNothing;
}

bool NumberKind::is_complete(const Question& question, const AnswerDraft& draft) const noexcept {
  return allowed_number(question, draft).has_value();
}

Answer NumberKind::answer(const Question& question, const AnswerDraft& draft) const {
  return {allowed_number(question, draft).value(), ""};
}

AnswerDraft NumberKind::draft_of(const Question&, const Answer& answer) const {
  AnswerDraft draft;
  type_number(answer.value, draft);
  return draft;
}

std::string NumberKind::parse(const Question& question, const std::string& words,
                              AnswerDraft& draft) const {
  draft.typed.set(words);
  if (!is_complete(question, draft)) {
    return fmt::format("the answer is '{}'; allowed: a number from {:g} to {:g}",
                       cut_text(words, 40), question.low, question.high);
  }
  return "";
}

std::string NumberKind::written(const Question&, const AnswerDraft& draft) const {
  return std::string(draft.typed.view());
}

AnswerView NumberKind::view(const Question&, const AnswerDraft& draft) const {
  AnswerView view;
  view.typed = draft.typed.view();
  return view;
}

std::string NumberKind::hint(const Question& question, const HintTexts& texts) const {
  return fmt::format("{} ({:g} – {:g})", texts.type_number, question.low, question.high);
}

void NumberKind::simulate(const Question& question, std::optional<double> felt,
                          RandomStream& random, AnswerDraft& draft) const noexcept {
  const double value = felt ? *felt : std::round(random.uniform(question.low, question.high));
  type_number(std::clamp(value, question.low, question.high), draft);
}

}  // namespace haptrial::questions
