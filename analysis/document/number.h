#pragma once

#include <string>

namespace haptrial::analysis {

/// Keeps a number and its unit on one line.
inline const std::string kNoBreak = "\u00a0";

/// Four significant digits, "0.1230".
std::string number(double value);
/// Text of a value beside the ends of its interval, as number() but "0" for mere rounding of them.
std::string number_within(double value, double low, double high);
/// "338.2 [330.1, 349.0]", "338.2 [330.1, open]" if an end is infinite, "338.2" if one is NaN, or
/// "–" if the value is.
std::string number_with_interval(double value, double low, double high);

}  // namespace haptrial::analysis
