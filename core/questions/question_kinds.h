#pragma once

#include <string>
#include <vector>

#include "core/questions/question_kind.h"

namespace haptrial::questions {

// The shipped kinds beside choice_kind() of question.h.

/// A mark between two ends.
const QuestionKind& scale_kind();
/// A number between bounds, which is typed.
const QuestionKind& number_kind();
/// Typed words of any script.
const QuestionKind& words_kind();
/// Consent to take part, which is accepted or declined.
const QuestionKind& consent_kind();
/// A text that is read and gone on from.
const QuestionKind& reading_kind();

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
