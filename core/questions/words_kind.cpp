#include "core/questions/words_kind.h"

#include <fmt/format.h>

#include "core/base/definition/table.h"

namespace haptrial::questions {

const QuestionKind& words_kind() {
  static const WordsKind kind;
  return kind;
}

bool WordsKind::is_stated(Table& table) const {
  table.describe({key(),
                  "Whether the answer is any typed words; else the question has choices, a scale "
                  "or a number",
                  "false", false});
  return table.has(key()) && table.boolean(key());
}

std::vector<int> WordsKind::heard_keys(const Question&) const { return {KeyPress::kBackspace}; }

KeyEffect WordsKind::press(const Question& question, const KeyPress& key,
                           AnswerDraft& draft) const noexcept {
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

bool WordsKind::is_complete(const Question& question, const AnswerDraft& draft) const noexcept {
  return draft.typed.view().size() <= question.most_bytes;
}

Answer WordsKind::answer(const Question&, const AnswerDraft& draft) const {
  return {std::numeric_limits<double>::quiet_NaN(), std::string(draft.typed.view())};
}

AnswerDraft WordsKind::draft_of(const Question&, const Answer& answer) const {
  AnswerDraft draft;
  draft.typed.set(answer.text);
  return draft;
}

std::string WordsKind::parse(const Question& question, const std::string& words,
                             AnswerDraft& draft) const {
  if (words.size() > question.most_bytes || words.find('\0') != std::string::npos) {
    return fmt::format("the answer has {} bytes; allowed: at most {}, without zero bytes",
                       words.size(), question.most_bytes);
  }
  draft.typed.set(words);
  return "";
}

std::string WordsKind::written(const Question&, const AnswerDraft& draft) const {
  return std::string(draft.typed.view());
}

AnswerView WordsKind::view(const Question&, const AnswerDraft& draft) const {
  AnswerView view;
  view.typed = draft.typed.view();
  return view;
}

std::string WordsKind::hint(const Question&, const HintTexts& texts) const {
  return texts.type_words;
}

void WordsKind::simulate(const Question&, std::optional<double>, RandomStream&,
                         AnswerDraft& draft) const noexcept {
  draft.typed.set("SIMULATED");
}

}  // namespace haptrial::questions
