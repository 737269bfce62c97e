#include "core/base/short_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace haptrial {
namespace {

std::string short_number(std::string_view part) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  const bool whole = error == std::errc() && end == part.data() + part.size();
  return whole ? fmt::format("{:.4g}", value) : std::string(part);
}

}  // namespace

std::string short_numbers(const std::string& list) {
  constexpr std::string_view kBetween = ", ";
  std::string words;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t end = std::min(list.find(kBetween, from), list.size());
    words += from == 0 ? "" : kBetween;
    words += short_number(std::string_view(list).substr(from, end - from));
    from = end + kBetween.size();
  }
  return words;
}

}  // namespace haptrial
