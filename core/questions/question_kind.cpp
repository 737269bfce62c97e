#include "core/questions/question_kind.h"

#include "core/base/definition/table.h"

namespace haptrial::questions {

bool QuestionKind::is_stated(Table& table) const { return table.has(key()); }

void QuestionKind::move_mark(const Question&, double, AnswerDraft&) const noexcept {}

double QuestionKind::share_of_mark(const Question&, const AnswerDraft&) const noexcept {
  return 0.5;
}

}  // namespace haptrial::questions
