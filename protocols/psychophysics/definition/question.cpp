#include "protocols/psychophysics/definition/question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/base/error.h"
#include "core/record/rows/response.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kMostChoices = 12;

std::uint32_t keys_of(Table& table, const char* key, KeyBits& bits) {
  std::uint32_t mask = 0;
  for (const int code : read_window_keys(table, key)) {
    mask |= bits.bit_of(code);
  }
  return mask;
}

/// Means of answering.
struct Means {
  KeyBits& keys;
  std::vector<std::string> regions;
};

void read_touch(Table& table, const Means& means, Choice& choice) {
  choice.touch = table.text("touch");
  if (std::ranges::find(means.regions, choice.touch) == means.regions.end()) {
    table.reject("touch", fmt::format("\"{}\"", choice.touch),
                 means.regions.empty()
                     ? "no region: the definition states none; add [regions.NAME]"
                     : fmt::format("a region: {}", fmt::join(means.regions, ", ")));
  }
}

Choice read_choice(Table& table, std::size_t place, Means& means) {
  KeyBits& keys = means.keys;
  Choice choice;
  choice.value = table.text("value");
  table.name_entry(choice.value);
  choice.label = table.shown_text("label", choice.value);
  if (table.has("keys")) {
    choice.keys = keys_of(table, "keys", keys);
    const std::vector<std::string> names = table.texts("keys");
    choice.hint = names.empty() ? "" : names.front();
  }
  if (table.has("buttons")) {
    choice.buttons = read_bits(table, "buttons");
  }
  if (table.has("touch")) {
    read_touch(table, means, choice);
  }
  if (table.has("pedal")) {
    choice.pedal = table.number("pedal", {0.0, 1.0, true}, "1");
  }
  if (choice.keys == 0 && choice.buttons == 0 && choice.touch.empty() && choice.pedal == 0.0) {
    choice.keys = keys.bit_of(static_cast<int>('1' + place));
    choice.hint = fmt::format("{}", place + 1);
    choice.buttons = std::uint32_t{1} << place;
  }
  if (choice.value.size() > record::kAnswerBytes) {
    table.reject("value", "too long", fmt::format("at most {} bytes", record::kAnswerBytes));
  }
  return choice;
}

/// The key in which two choices are the same; null: in none.
const char* same_key(const Choice& a, const Choice& b) {
  return a.value == b.value                       ? "value"
         : (a.keys & b.keys) != 0                 ? "keys"
         : (a.buttons & b.buttons) != 0           ? "buttons"
         : !a.touch.empty() && a.touch == b.touch ? "touch"
         : a.pedal > 0.0 && b.pedal > 0.0         ? "pedal"
                                                  : nullptr;
}

void read_choices(Table& table, Question& question, Means& means) {
  std::vector<Table> choices = table.tables("choices");
  if (choices.size() < 2 || choices.size() > kMostChoices) {
    table.reject("choices", fmt::format("a list of {}", choices.size()),
                 fmt::format("2 to {} choices", kMostChoices));
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    question.choices.push_back(read_choice(choices[i], i, means));
    for (std::size_t before = 0; before < i; ++before) {
      const char* key = same_key(question.choices[before], question.choices[i]);
      if (key != nullptr) {
        choices[i].reject(
            key, fmt::format("that of choices[{}]", before + 1),
            "a choice whose value, keys, buttons, place and pedal no other choice has");
        break;
      }
    }
  }
  const auto touched = std::ranges::count_if(
      question.choices, [](const Choice& choice) { return !choice.touch.empty(); });
  if (std::cmp_greater(touched, kMostTouched)) {
    table.reject("choices", fmt::format("a list with {} places to touch", touched),
                 fmt::format("at most {}", kMostTouched));
  }
}

void read_scale(Table& table, Question& question, KeyBits& keys) {
  const std::vector<double> range = table.numbers("scale", {0.0, 9.0}, "");
  const bool whole =
      std::all_of(range.begin(), range.end(), [](double each) { return each == std::floor(each); });
  if (range.size() != 2 || !whole || range[1] <= range[0]) {
    table.reject("scale", "another list", "[lowest, highest], whole numbers from 0 to 9");
    return;
  }
  question.first = range[0];
  for (double value = range[0]; value <= range[1]; ++value) {
    const std::string digit = fmt::format("{:.0f}", value);
    const auto button = static_cast<unsigned>(value - range[0]);
    question.choices.push_back(
        {digit, digit, "", keys.bit_of(digit.front()), std::uint32_t{1} << button});
  }
}

void read_number(Table& table, Question& question, KeyBits& keys) {
  const std::vector<double> range = table.numbers("number", {}, "");
  if (range.size() != 2 || range[1] <= range[0]) {
    table.reject("number", "another list", "[lowest, highest]");
    return;
  }
  question.low = range[0];
  question.high = range[1];
  static constexpr std::array kTyping{'0' + 0, '1' + 0,       '2' + 0,  '3' + 0, '4' + 0,
                                      '5' + 0, '6' + 0,       '7' + 0,  '8' + 0, '9' + 0,
                                      '.' + 0, kBackspaceKey, kEnterKey};
  for (const int code : kTyping) {
    question.typing.push_back(keys.bit_of(code));
  }
}

/// Reads the limits of an answer's time: the text after one that comes too early or too late, and
/// the consequence.
void read_limits(Table& table, Table& root, Question& question) {
  constexpr Bounds kLimit{0.0, 3600.0, true};
  if (table.has("too_fast")) {
    question.too_fast = table.number("too_fast", kLimit, "s");
  }
  if (table.has("too_slow")) {
    question.too_slow = table.number("too_slow", kLimit, "s");
  }
  if (table.has("out_of_time")) {
    question.again = table.choice("out_of_time", {"go on", "repeat"}) == "repeat";
    if (!question.has_limits()) {
      table.reject("out_of_time", "stands alone; add too_fast or too_slow, a limit in seconds");
    }
  }
  if (question.has_limits()) {
    Table texts = root.table("texts");
    question.fast_text = texts.shown_text("too_fast", "Too fast");
    question.slow_text = texts.shown_text("too_slow", "Too slow");
  }
  if (question.too_fast >= question.too_slow) {
    table.reject("too_slow", fmt::format("{} s", question.too_slow),
                 fmt::format("above too_fast, {} s", question.too_fast));
  }
  if (std::isfinite(question.too_slow) && question.timeout > 0.0 &&
      question.timeout <= question.too_slow) {
    table.reject("too_slow", fmt::format("{} s", question.too_slow),
                 fmt::format("below timeout, {} s, which ends the trial", question.timeout));
  }
}

/// @param listed  one of several, which translations tell apart by their names
Question read_question(Table& table, Table& root, Means& means, bool listed) {
  KeyBits& keys = means.keys;
  Question question;
  question.name = "answer";
  if (table.has("name")) {
    question.name = table.text("name");
  }
  if (listed) {
    table.name_entry(question.name);
  }
  question.text = table.shown_text("question");
  const int kinds =
      (table.has("choices") ? 1 : 0) + (table.has("scale") ? 1 : 0) + (table.has("number") ? 1 : 0);
  if (kinds != 1) {
    table.reject("question", "has no one way to be answered; state one of choices, scale, number");
  } else if (table.has("choices")) {
    read_choices(table, question, means);
  } else if (table.has("scale")) {
    read_scale(table, question, keys);
  } else {
    read_number(table, question, keys);
  }
  if (table.has("correct")) {
    question.correct = table.text("correct");
  }
  if (table.has("feedback")) {
    const std::string when = table.choice("feedback", {"never", "practice", "always"});
    question.feedback = when == "always"     ? Feedback::kAlways
                        : when == "practice" ? Feedback::kPractice
                                             : Feedback::kNever;
    if (question.feedback != Feedback::kNever && question.correct.empty()) {
      table.reject("feedback", fmt::format("\"{}\"", when),
                   "\"never\" unless `correct` says which answer is right");
    }
  }
  if (table.has("timeout")) {
    question.timeout = table.number("timeout", {0.1, 3600.0}, "s");
  }
  if (table.has("reaction_time_from")) {
    question.onset = table.text("reaction_time_from");
  }
  if (table.has("touch_for")) {
    question.touch_for = table.number("touch_for", {0.0, 60.0}, "s");
    if (!question.touched()) {
      table.reject("touch_for", "stands alone; add touch, a region, to a choice");
    }
  }
  read_limits(table, root, question);
  if (question.name.size() > record::kQuestionBytes) {
    table.reject("name", "too long", fmt::format("at most {} bytes", record::kQuestionBytes));
  }
  return question;
}

}  // namespace

std::vector<std::string> Question::answers() const {
  std::vector<std::string> values;
  for (const Choice& choice : choices) {
    values.push_back(choice.value);
  }
  return values.empty() ? std::vector<std::string>{"number"} : values;
}

bool Question::touched() const {
  return std::ranges::any_of(choices, [](const Choice& choice) { return !choice.touch.empty(); });
}

bool Question::has_limits() const { return too_fast > 0.0 || std::isfinite(too_slow); }

Pace Question::pace_of(double reaction_time) const noexcept {
  return reaction_time < too_fast   ? Pace::kTooFast
         : reaction_time > too_slow ? Pace::kTooSlow
                                    : Pace::kInTime;
}

std::uint32_t KeyBits::bit_of(int code) {
  const auto found = std::find(codes_.begin(), codes_.end(), code);
  const auto place = static_cast<std::size_t>(found - codes_.begin());
  if (found == codes_.end()) {
    if (codes_.size() == kMost) {
      throw InputError(fmt::format("more than {} keys are used; use fewer", kMost));
    }
    codes_.push_back(code);
  }
  return std::uint32_t{1} << place;
}

std::uint32_t KeyBits::bits_of(const std::vector<int>& held) const {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    if (std::find(held.begin(), held.end(), codes_[i]) != held.end()) {
      bits |= std::uint32_t{1} << i;
    }
  }
  return bits;
}

std::vector<Question> read_questions(Table& root, KeyBits& keys) {
  std::vector<Question> questions;
  Means means{keys,
              root.has("regions") ? root.table("regions").keys() : std::vector<std::string>{}};
  if (root.has("response")) {
    Table table = root.table("response");
    questions.push_back(read_question(table, root, means, false));
  }
  if (root.has("responses")) {
    if (!questions.empty()) {
      root.reject("responses", "stands beside [response]; keep one of the two");
    }
    for (Table& table : root.tables("responses")) {
      questions.push_back(read_question(table, root, means, true));
      const auto same = [&](const Question& each) { return each.name == questions.back().name; };
      if (std::any_of(questions.begin(), questions.end() - 1, same)) {
        table.reject("name", fmt::format("\"{}\"", questions.back().name),
                     "a name that no other response has");
      }
    }
  }
  return questions;
}

}  // namespace haptrial::protocols
