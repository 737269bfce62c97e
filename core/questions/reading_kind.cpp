#include "core/questions/reading_kind.h"

#include "core/questions/kind_parts.h"

namespace haptrial::questions {

const QuestionKind& reading_kind() {
  static const ReadingKind kind;
  return kind;
}

void ReadingKind::read(Table& table, Question& question) const {
  title_schema().read(table, question);
  reading_schema().read(table, question);
}

KeyEffect ReadingKind::press(const Question&, const KeyPress& key, AnswerDraft&) const noexcept {
  return key.key == KeyPress::kSpace ? KeyEffect::kGiven : KeyEffect::kNothing;
}

}  // namespace haptrial::questions
