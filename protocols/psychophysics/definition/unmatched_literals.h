#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptrial::protocols {

/// Sentences on words that formulas of a definition compare something with, "$shape == 'spere'",
/// and that stand nowhere else in it: nothing is ever equal to them. None where all is well.
/// @param definition  its text
std::vector<std::string> unmatched_literals(std::string_view definition);

}  // namespace haptrial::protocols
