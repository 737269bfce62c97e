#include "core/questions/kind_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace haptrial::questions {
namespace {

constexpr double kMostSteps = 200.0;

}  // namespace

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

int steps_of(const Question& question) noexcept {
  return static_cast<int>(std::lround((question.high - question.low) / question.step));
}

double value_of_step(const Question& question, int step) noexcept {
  return question.low + question.step * step;
}

int step_near(const Question& question, double value) noexcept {
  constexpr double kFar = 1e9;
  return static_cast<int>(
      std::lround(std::clamp((value - question.low) / question.step, -kFar, kFar)));
}

Schema<Question> steps_schema(std::string key, std::string description, std::string otherwise) {
  Schema<Question> schema;
  schema.custom(key, std::move(description), read_range)
      .otherwise(std::move(otherwise))
      .number("step", &Question::step, {0.0, 1e9, true}, "",
              "Distance between neighbouring values of a scale")
      .otherwise("1; after a trial, without `ends`, digits are typed")
      .check([key](Table& table, Question& question) {
        const double steps = (question.high - question.low) / question.step;
        if (std::abs(steps - std::round(steps)) > 1e-9 * steps || steps > kMostSteps) {
          table.reject(table.has("step") ? "step" : key, fmt::format("{} steps long", steps),
                       fmt::format("a whole number of steps, at most {}", kMostSteps));
        }
      });
  return schema;
}

}  // namespace haptrial::questions
