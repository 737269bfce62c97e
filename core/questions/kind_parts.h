#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/questions/question.h"
#include "core/questions/question_kind.h"

namespace haptrial::questions {

// Parts that several kinds of questions share, also a program's own.

/// Bounds of names and values in files [bytes].
inline constexpr std::size_t kNameBytes = 64;
/// Longest text of a question; more would not be legible on a screen [bytes].
inline constexpr std::size_t kLongestText = 4000;

/// title
const Schema<Question>& title_schema();
/// text and picture
const Schema<Question>& reading_schema();

/// Gives an entry of a list its name, which files and translations have. A name with a point, or
/// one that is too long, is noted as a problem.
void name_entry(Table& table, const char* key, const std::string& name);

/// Reads [lowest, highest] into the bounds of a question; another list is noted as a problem.
void read_range(Table& table, const std::string& key, Question& question);

/// The number that a text is, with a decimal point or a comma; nothing if it is none. Servo thread:
/// no allocation, lock, I/O or throw.
std::optional<double> number_in(std::string_view text) noexcept;

/// The keys 0 to 9 and the given ones.
std::vector<int> digits_and(std::initializer_list<int> others);

// Parts of a scale that other kinds with steps share.

/// Steps between both ends of a question, at least 1.
int steps_of(const Question& question) noexcept;
/// The number of a step.
double value_of_step(const Question& question, int step) noexcept;
/// The step that is nearest to a number, which may lie beyond both ends.
int step_near(const Question& question, double value) noexcept;
/// The key of a range, under a name of the kind's own, and `step`.
/// @param key, description, otherwise  as KeyDescription has them
Schema<Question> steps_schema(std::string key, std::string description, std::string otherwise);

}  // namespace haptrial::questions
