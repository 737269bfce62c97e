#include "analysis/psychophysics/exchange/field_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace haptrial::analysis::trials {

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string_view unwrapped(std::string_view text) {
  const bool list = text.size() > 2 && text.front() == '[' && text.back() == ']';
  if (list && text.find(',') == text.npos) {
    text = text.substr(1, text.size() - 2);
  }
  const bool quoted = text.size() > 2 && text.front() == text.back() &&
                      (text.front() == '\'' || text.front() == '"');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

bool is_missing(std::string_view text) {
  constexpr std::array<std::string_view, 10> kMissing{"",    "null", "None", "NA",        "N/A",
                                                      "n/a", "NaN",  "nan",  "undefined", "[]"};
  return std::ranges::find(kMissing, text) != kMissing.end();
}

}  // namespace haptrial::analysis::trials
