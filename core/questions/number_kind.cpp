#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"
#include "core/questions/question_kinds.h"

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

/// A number between bounds, which is typed.
class NumberKind final : public QuestionKind {
 public:
  std::string word() const override { return "number"; }
  QuestionTraits traits() const noexcept override { return {.types = true}; }
  std::string key() const override { return "number"; }

  void read(Table& table, Question& question) const override {
    number_schema().read(table, question);
  }

  std::vector<int> heard_keys(const Question& question) const override {
    return question.low < 0.0 ? digits_and({'.', KeyPress::kBackspace, '-'})
                              : digits_and({'.', KeyPress::kBackspace});
  }

  KeyEffect press(const Question&, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override {
    if (key.key == KeyPress::kBackspace) {
      return draft.typed.remove_last() ? KeyEffect::kChanged : KeyEffect::kNothing;
    }
    const bool allowed = key.character != 0 && key.character < 0x80 &&
                         std::string_view("0123456789.,-").find(static_cast<char>(key.character)) !=
                             std::string_view::npos;
    return allowed && draft.typed.append(key.character) ? KeyEffect::kChanged : KeyEffect::kNothing;
  }

  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override {
    return allowed_number(question, draft).has_value();
  }

  Answer answer(const Question& question, const AnswerDraft& draft) const override {
    return {allowed_number(question, draft).value(), ""};
  }

  AnswerDraft draft_of(const Question&, const Answer& answer) const override {
    AnswerDraft draft;
    type_number(answer.value, draft);
    return draft;
  }

  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    draft.typed.set(words);
    if (!is_complete(question, draft)) {
      return fmt::format("the answer is '{}'; allowed: a number from {:g} to {:g}",
                         cut_text(words, 40), question.low, question.high);
    }
    return "";
  }

  std::string written(const Question&, const AnswerDraft& draft) const override {
    return std::string(draft.typed.view());
  }

  AnswerView view(const Question&, const AnswerDraft& draft) const override {
    AnswerView view;
    view.typed = draft.typed.view();
    return view;
  }

  std::string hint(const Question& question, const HintTexts& texts) const override {
    return fmt::format("{} ({:g} – {:g})", texts.type_number, question.low, question.high);
  }

  void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                AnswerDraft& draft) const noexcept override {
    const double value = felt ? *felt : std::round(random.uniform(question.low, question.high));
    type_number(std::clamp(value, question.low, question.high), draft);
  }
};

}  // namespace

const QuestionKind& number_kind() {
  static const NumberKind kind;
  return kind;
}

}  // namespace haptrial::questions
