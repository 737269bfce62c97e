#include "core/questions/question_kind.h"

#include "core/base/definition/table.h"

namespace haptrial::questions {

bool QuestionKind::is_stated(Table& table) const { return table.has(key()); }

}  // namespace haptrial::questions
