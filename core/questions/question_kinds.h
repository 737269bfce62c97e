#pragma once

#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::questions {

class QuestionKind;

/// Every kind of question, in the order in which sentences list their keys. Call before threads are
/// started.
const std::vector<const QuestionKind*>& kinds_of_question();

/// Adds a kind of a program's own, which outlives every definition.
/// @throws std::invalid_argument for a word or a key that is taken
void add_kind_of_question(const QuestionKind& kind);

/// The keys of these kinds, for sentences: "choices, scale, number, words".
std::string keys_of_kinds(const std::vector<const QuestionKind*>& kinds);

/// The kind that a table states, one of `kinds`; null if it states none or several. The caller
/// notes the problem.
const QuestionKind* stated_kind(Table& table, const std::vector<const QuestionKind*>& kinds);

}  // namespace haptrial::questions
