#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace haptrial::test {

/// The text with `by` in place of the first `what`.
/// @throws std::invalid_argument if it is not there: the test is older than its text.
inline std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const auto at = text.find(what);
  if (at == std::string::npos) {
    throw std::invalid_argument("the text does not hold: " + std::string(what));
  }
  return text.replace(at, what.size(), by);
}

}  // namespace haptrial::test
