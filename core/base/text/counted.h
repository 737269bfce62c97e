#pragma once

#include <string>
#include <string_view>

namespace haptrial {

/// "1 session", "2 sessions".
template <class Number>
std::string counted(Number number, std::string_view one, std::string_view many) {
  return std::to_string(number).append(" ").append(number == Number{1} ? one : many);
}

}  // namespace haptrial
