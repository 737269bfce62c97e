#include <fmt/format.h>

#include "core/base/definition/table.h"
#include "core/questions/question_kind.h"
#include "core/questions/question_kinds.h"

namespace haptrial::questions {
namespace {

/// Typed words of any script. An answer may be empty.
class WordsKind final : public QuestionKind {
 public:
  std::string word() const override { return "words"; }
  QuestionTraits traits() const noexcept override {
    return {.scored = false, .types = true, .any_character = true};
  }
  std::string key() const override { return "words"; }
  void read(Table&, Question&) const override {}

  bool is_stated(Table& table) const override {
    table.describe({key(),
                    "Whether the answer is any typed words; else the question has choices, a scale "
                    "or a number",
                    "false", false});
    return table.has(key()) && table.boolean(key());
  }

  std::vector<int> heard_keys(const Question&) const override { return {KeyPress::kBackspace}; }

  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override {
    if (key.key == KeyPress::kBackspace) {
      return draft.typed.remove_last() ? KeyEffect::kChanged : KeyEffect::kNothing;
    }
    if (key.character < ' ' || key.character == 0x7f || !draft.typed.append(key.character)) {
      return KeyEffect::kNothing;
    }
    if (draft.typed.view().size() > question.most_bytes) {
      draft.typed.remove_last();
      return KeyEffect::kNothing;
    }
    return KeyEffect::kChanged;
  }

  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override {
    return draft.typed.view().size() <= question.most_bytes;
  }

  Answer answer(const Question&, const AnswerDraft& draft) const override {
    return {std::numeric_limits<double>::quiet_NaN(), std::string(draft.typed.view())};
  }

  AnswerDraft draft_of(const Question&, const Answer& answer) const override {
    AnswerDraft draft;
    draft.typed.set(answer.text);
    return draft;
  }

  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    if (words.size() > question.most_bytes || words.find('\0') != std::string::npos) {
      return fmt::format("the answer has {} bytes; allowed: at most {}, without zero bytes",
                         words.size(), question.most_bytes);
    }
    draft.typed.set(words);
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

  std::string hint(const Question&, const HintTexts& texts) const override {
    return texts.type_words;
  }

  void simulate(const Question&, std::optional<double>, RandomStream&,
                AnswerDraft& draft) const noexcept override {
    draft.typed.set("SIMULATED");
  }
};

}  // namespace

const QuestionKind& words_kind() {
  static const WordsKind kind;
  return kind;
}

}  // namespace haptrial::questions
