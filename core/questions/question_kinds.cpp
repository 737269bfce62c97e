#include "core/questions/question_kinds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "core/base/definition/table.h"

namespace haptrial::questions {
namespace {

std::vector<const QuestionKind*>& all_kinds() {
  static std::vector<const QuestionKind*> kinds{&choice_kind(), &scale_kind(),   &number_kind(),
                                                &words_kind(),  &consent_kind(), &reading_kind()};
  return kinds;
}

}  // namespace

const std::vector<const QuestionKind*>& kinds_of_question() { return all_kinds(); }

void add_kind_of_question(const QuestionKind& kind) {
  for (const QuestionKind* each : all_kinds()) {
    const bool same_key = !kind.key().empty() && each->key() == kind.key();
    if (each->word() == kind.word() || same_key) {
      throw std::invalid_argument(
          fmt::format("add_kind_of_question: there is a question '{}' already", kind.word()));
    }
  }
  all_kinds().push_back(&kind);
}

std::string keys_of_kinds(const std::vector<const QuestionKind*>& kinds) {
  std::vector<std::string> keys;
  for (const QuestionKind* kind : kinds) {
    if (!kind->key().empty()) {
      keys.push_back(kind->key());
    }
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

const QuestionKind* stated_kind(Table& table, const std::vector<const QuestionKind*>& kinds) {
  const QuestionKind* found = nullptr;
  int count = 0;
  for (const QuestionKind* kind : kinds) {
    if (!kind->key().empty() && kind->is_stated(table)) {
      found = kind;
      ++count;
    }
  }
  for (const QuestionKind* kind : kinds) {
    if (count > 1 && !kind->key().empty()) {
      table.pass_over(kind->key());  // known, so that the sentence is about their number
    }
  }
  return count == 1 ? found : nullptr;
}

}  // namespace haptrial::questions
