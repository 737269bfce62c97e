#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/psychophysics/exchange/imported_trials.h"

namespace haptrial::analysis::trials {

/// Names of the variable and questions in a definition that is made for a table.
inline constexpr const char* kImportedLevel = "level";
inline constexpr const char* kImportedAnswer = "answer";
inline constexpr const char* kImportedRating = "rating";

/// How trials from a table are to be analysed.
struct ImportedAnalysis {
  std::string name;             // of the study
  std::string kind;             // of [analysis]; empty: as the columns are
  std::string yes;              // answer that counts 1; empty: the right one
  std::optional<double> guess;  // rate of the functions; nothing: 1 / answers
};

/// Answers of the trials, sorted; with right and wrong alone these two words.
std::vector<std::string> answers_of(const ImportedStudy& study);

/// The answer of a trial as a word: "right" or "wrong" where the table has no answers.
std::string answer_word(const ImportedStudy& study, const ImportedTrial& trial);

/// The guess rate that the number of different answers gives, and the answers with their trials, so
/// that a mistyped one is seen; empty where the rate is stated or not used.
/// @throws InputError as imported_definition()
std::string guess_note(const ImportedStudy& study, const ImportedAnalysis& analysis);

/// The task of an identification of two answers, which no column says, and how to state another;
/// empty for other analyses.
/// @throws InputError as imported_definition()
std::string task_note(const ImportedStudy& study, const ImportedAnalysis& analysis);

/// Text of a definition of protocol "trials" by which imported trials are analysed. It presents
/// nothing: its only stage ends at once.
/// @throws InputError if the columns do not say which answer counts, or do not fit the kind
std::string imported_definition(const ImportedStudy& study, const ImportedAnalysis& analysis);

}  // namespace haptrial::analysis::trials
