#include "core/questions/kind_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace haptrial::questions {

const Schema<Question>& title_schema() {
  static const auto schema =
      Schema<Question>()
          .shown_text("title", &Question::title, kLongestText, "Heading of the page")
          .otherwise("none");
  return schema;
}

const Schema<Question>& reading_schema() {
  static const auto schema =
      Schema<Question>()
          .shown_text("text", &Question::text, kLongestText, "Text of the page")
          .required()
          .text("picture", &Question::picture,
                "Picture on the page, a PNG file relative to the definition")
          .otherwise("none");
  return schema;
}

void name_entry(Table& table, const char* key, const std::string& name) {
  if (name.size() > kNameBytes || name.find('.') != std::string::npos) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a name without a point, of at most {} bytes", kNameBytes));
  }
  table.name_entry(name);
}

void read_range(Table& table, const std::string& key, Question& question) {
  const std::vector<double> range = table.numbers(key, {}, "");
  if (range.size() != 2 || range[1] <= range[0]) {
    table.reject(key, "another list", "[lowest, highest]");
    question.high = question.low + 100.0;
    return;
  }
  question.low = range[0];
  question.high = range[1];
}

std::optional<double> number_in(std::string_view text) noexcept {
  std::array<char, 64> decimal{};
  if (text.size() > decimal.size()) {
    return std::nullopt;
  }
  std::ranges::replace_copy(text, decimal.begin(), ',', '.');  // a decimal comma
  const char* const end = decimal.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(decimal.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value) ? std::optional(value)
                                                                     : std::nullopt;
}

std::vector<int> digits_and(std::initializer_list<int> others) {
  std::vector<int> keys{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9'};
  keys.insert(keys.end(), others);
  return keys;
}

}  // namespace haptrial::questions
