#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptrial::analysis::trials {

/// A text with its ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The finite number that a whole text is; nothing: it is none.
std::optional<double> number_in(std::string_view text);

/// Whether a field stands for no value: "", "null", "None", "NA" and the like.
bool is_missing(std::string_view text);

/// The entry of a list of one, ['left'] or ["left"], as PsychoPy and jsPsych write some answers;
/// any other text as it is.
std::string_view unwrapped(std::string_view text);

}  // namespace haptrial::analysis::trials
