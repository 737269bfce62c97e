#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace haptrial {

/// "1 session", "2 sessions".
template <class Number>
std::string counted(Number number, std::string_view one, std::string_view many) {
  return std::to_string(number).append(" ").append(number == Number{1} ? one : many);
}

/// "12 minutes": a planned time, rounded, of at least one minute.
inline std::string planned_minutes(double seconds) {
  return counted(std::max(1L, std::lround(seconds / 60.0)), "minute", "minutes");
}

}  // namespace haptrial
