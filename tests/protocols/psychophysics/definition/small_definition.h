#pragma once

#include <string>
#include <vector>

#include "protocols/psychophysics/definition/read_definition.h"

namespace haptrial::protocols {

/// A definition of trials that is good as it is: two intervals, one answer, a wall. What is added
/// is written behind it. @param procedure  its [procedure]
std::string small_trials(const std::string& procedure, const std::string& more = "");

/// A staircase of the variable `level`, for small_trials().
extern const char* const kSmallStaircase;

/// Problems of a definition of trials, a sentence each; also those that only some of its values
/// would show.
std::vector<std::string> problems_of_trials(const std::string& text);

/// @throws InputError as its problems
void read_small(const std::string& text, TrialsDefinition& definition);

}  // namespace haptrial::protocols
