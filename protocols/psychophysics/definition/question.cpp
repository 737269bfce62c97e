#include "protocols/psychophysics/definition/question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/questions/question_kinds.h"
#include "core/record/rows/answer_rows.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {
namespace {

using questions::Choice;
using questions::QuestionKind;

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

const Schema<Choice>& trial_choice_schema() {
  using C = Choice;
  static const auto schema =
      Schema<C>()
          .text("value", &C::value, "Value of the choice, in formulas and files")
          .required()
          .check([](Table& table, C& choice) {
            table.name_entry(choice.value);
            choice.label = choice.value;
          })
          .shown_text("label", &C::label, "Words of the choice that participants read")
          .otherwise("the value");
  return schema;
}

const Schema<ChoiceMeans>& means_schema() {
  using C = ChoiceMeans;
  static const auto schema =
      Schema<C>()
          .bits("buttons", &C::buttons, "Buttons of the device that make the choice")
          .otherwise("the button of its place")
          .text("touch", &C::touch,
                "Region into which the tip of the tool is moved to make the choice")
          .otherwise("none")
          .number("pedal", &C::pedal, {0.0, 1.0, true}, "1",
                  "Depth from which on an analog pedal makes the choice")
          .otherwise("none")
          .flag("silent", &C::silent,
                "Whether it is the choice of participants who give no answer within `timeout`");
  return schema;
}

void read_choice_keys(Table& table, KeyBits& keys, ChoiceMeans& choice) {
  table.describe({"keys", "Keys of the participant's window that make the choice",
                  "the digit of its place", false});
  if (table.has("keys")) {
    choice.keys = keys_of(table, "keys", keys);
    const std::vector<std::string> names = table.texts("keys");
    choice.hint = names.empty() ? "" : names.front();
  }
}

void check_touch(Table& table, const Means& means, const ChoiceMeans& choice) {
  if (table.has("touch") && std::ranges::find(means.regions, choice.touch) == means.regions.end()) {
    table.reject("touch", fmt::format("\"{}\"", choice.touch),
                 means.regions.empty()
                     ? "no region: the definition states none; add [regions.NAME]"
                     : fmt::format("a region: {}", fmt::join(means.regions, ", ")));
  }
}

ChoiceMeans read_means(Table& table, std::size_t place, Means& means) {
  ChoiceMeans choice = means_schema().read(table);
  read_choice_keys(table, means.keys, choice);
  check_touch(table, means, choice);
  const bool stated =
      choice.keys != 0 || choice.buttons != 0 || !choice.touch.empty() || choice.pedal > 0.0;
  if (!stated && !choice.silent) {
    choice.keys = means.keys.bit_of(static_cast<int>('1' + place));
    choice.hint = fmt::format("{}", place + 1);
    choice.buttons = std::uint32_t{1} << place;
  }
  return choice;
}

Choice read_trial_choice(Table& table) {
  Choice choice = trial_choice_schema().read(table);
  if (choice.value.size() > record::kAnswerBytes) {
    table.reject("value", "too long", fmt::format("at most {} bytes", record::kAnswerBytes));
  }
  return choice;
}

/// The key in which two choices are the same; null: in none.
const char* same_key(const TrialQuestion& question, std::size_t one, std::size_t other) {
  const ChoiceMeans &a = question.means[one], &b = question.means[other];
  return question.choices[one].value == question.choices[other].value ? "value"
         : (a.keys & b.keys) != 0                                     ? "keys"
         : (a.buttons & b.buttons) != 0                               ? "buttons"
         : !a.touch.empty() && a.touch == b.touch                     ? "touch"
         : a.pedal > 0.0 && b.pedal > 0.0                             ? "pedal"
                                                                      : nullptr;
}

void read_choices(Table& table, TrialQuestion& question, Means& means) {
  std::vector<Table> choices = table.tables("choices");
  if (choices.size() < 2 || choices.size() > kMostChoices) {
    table.reject("choices", fmt::format("a list of {}", choices.size()),
                 fmt::format("2 to {} choices", kMostChoices));
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    question.choices.push_back(read_trial_choice(choices[i]));
    question.means.push_back(read_means(choices[i], i, means));
    for (std::size_t before = 0; before < i; ++before) {
      const char* key = same_key(question, before, i);
      if (key != nullptr) {
        choices[i].reject(
            key, fmt::format("that of choices[{}]", before + 1),
            "a choice whose value, keys, buttons, place and pedal no other choice has");
        break;
      }
    }
  }
  const auto touched = std::ranges::count_if(
      question.means, [](const ChoiceMeans& choice) { return !choice.touch.empty(); });
  if (std::cmp_greater(touched, kMostTouched)) {
    table.reject("choices", fmt::format("a list with {} places to touch", touched),
                 fmt::format("at most {}", kMostTouched));
  }
}

/// Reads a rating by digits, which are choices.
void read_digits(Table& table, TrialQuestion& question, KeyBits& keys) {
  table.describe({"scale",
                  "Lowest and highest value of a scale on which a mark is moved; after a trial, "
                  "without `step` and `ends`, lowest and highest digit",
                  "choices, a number or words", false});
  const std::vector<double> range = table.numbers("scale", {}, "");
  const bool digits = std::all_of(range.begin(), range.end(), [](double each) {
    return each == std::floor(each) && each >= 0.0 && each <= 9.0;
  });
  if (range.size() != 2 || !digits || range[1] <= range[0]) {
    table.reject("scale", "another list",
                 "[lowest, highest], whole numbers from 0 to 9; on another scale a mark is moved: "
                 "add step, ends or by");
    return;
  }
  question.first = range[0];
  for (double value = range[0]; value <= range[1]; ++value) {
    const std::string digit = fmt::format("{:.0f}", value);
    const auto button = static_cast<unsigned>(value - range[0]);
    question.choices.push_back({digit, digit});
    question.means.push_back({"", keys.bit_of(digit.front()), std::uint32_t{1} << button});
  }
}

/// The kinds that a trial asks.
std::vector<const QuestionKind*> kinds_in_trials() {
  std::vector<const QuestionKind*> kinds;
  std::ranges::copy_if(questions::kinds_of_question(), std::back_inserter(kinds),
                       [](const QuestionKind* kind) { return kind->traits().in_trials; });
  return kinds;
}

/// The keys of a question without choices, and enter, which gives the answer. A mark that the hand
/// or the mouse moves hears no other.
void hear_keys(TrialQuestion& question, KeyBits& keys) {
  const bool by_keys = question.mark.by == MarkedBy::kKeys;
  for (const int key : question.kind->heard_keys(question)) {
    if (by_keys) {
      question.heard.push_back({keys.bit_of(key), key});
    }
  }
  question.heard.push_back({keys.bit_of(KeyPress::kEnter), KeyPress::kEnter});
  if (question.kind->traits().any_character) {
    keys.use_characters();
  }
}

void read_answer(Table& table, TrialQuestion& question, Means& means) {
  const std::vector<const QuestionKind*> kinds = kinds_in_trials();
  const QuestionKind* kind = questions::stated_kind(table, kinds);
  if (kind == nullptr) {
    table.reject("question", fmt::format("has no one way to be answered; state one of {}",
                                         questions::keys_of_kinds(kinds)));
  } else if (kind == &questions::choice_kind()) {
    read_choices(table, question, means);
  } else if (kind == &questions::scale_kind() && !table.has("step") && !table.has("ends") &&
             !table.has("by")) {
    read_digits(table, question, means.keys);
  } else {
    question.kind = kind;
    kind->read(table, question);
    if (kind->traits().marks) {
      mark_schema().read(table, question.mark);
    }
    hear_keys(question, means.keys);
  }
}

void check_feedback(Table& table, TrialQuestion& question) {
  if (question.feedback != Feedback::kNever && question.correct.empty()) {
    table.reject("feedback", question.feedback == Feedback::kAlways ? "\"always\"" : "\"practice\"",
                 "\"never\" unless `correct` says which answer is right");
  }
}

void check_touch_time(Table& table, TrialQuestion& question) {
  if (table.has("touch_for") && !question.touched()) {
    table.reject("touch_for", "stands alone; add touch, a region, to a choice");
  }
}

/// Silence says one thing, and only once the time is over.
void check_silence(Table& table, TrialQuestion& question) {
  const auto silent =
      std::ranges::count_if(question.means, [](const ChoiceMeans& each) { return each.silent; });
  if (silent > 1) {
    table.reject("choices", fmt::format("a list with {} silent choices", silent),
                 "at most one with silent = true");
  } else if (silent == 1 && question.timeout == 0.0) {
    table.reject("choices",
                 "has a choice with silent = true, but nothing says when it is given; add timeout, "
                 "the time for an answer");
  }
}

void check_limits(Table& table, TrialQuestion& question) {
  if (table.has("out_of_time") && !question.has_limits()) {
    table.reject("out_of_time", "stands alone; add too_fast or too_slow, a limit in seconds");
  }
  if (question.too_fast >= question.too_slow) {
    table.reject("too_slow", fmt::format("{} s", question.too_slow),
                 fmt::format("above too_fast, {} s", question.too_fast));
  }
  const bool both_from_the_question = question.onset.empty();
  if (std::isfinite(question.too_slow) && question.timeout > 0.0 && both_from_the_question &&
      question.timeout <= question.too_slow) {
    table.reject("too_slow", fmt::format("{} s", question.too_slow),
                 fmt::format("below timeout, {} s, which ends the trial", question.timeout));
  }
}

constexpr Bounds kLimit{0.0, 3600.0, true};  // [s]

/// Keys of a question whose answers are read.
const Schema<TrialQuestion>& question_schema() {
  using Q = TrialQuestion;
  static const auto schema =
      Schema<Q>()
          .text("correct", &Q::correct,
                "Formula of the right choice: its number, or its value as a word")
          .otherwise("no answer is right")
          .choice("feedback", &Q::feedback,
                  {{"never", Feedback::kNever},
                   {"practice", Feedback::kPractice},
                   {"always", Feedback::kAlways}},
                  "Trials after which participants are shown whether the answer was right")
          .check(check_feedback)
          .number(
              "timeout", &Q::timeout, {0.1, 3600.0}, "s",
              "Time for an answer; then the silent choice is given, and without one the trial is "
              "aborted and comes again")
          .otherwise("none")
          .check(check_silence)
          .text("reaction_time_from", &Q::onset,
                "Stage from whose beginning the reaction time is counted")
          .otherwise("the question")
          .number("touch_for", &Q::touch_for, {0.0, 60.0}, "s",
                  "Time for which the tip of the tool stays in a region to make a choice")
          .check(check_touch_time)
          .number("too_fast", &Q::too_fast, kLimit, "s",
                  "Reaction time below which participants read that the answer was too fast")
          .otherwise("no limit")
          .number("too_slow", &Q::too_slow, kLimit, "s",
                  "Reaction time above which participants read that the answer was too slow")
          .otherwise("no limit")
          .choice("out_of_time", &Q::again, {{"go on", false}, {"repeat", true}},
                  "Consequence of an answer that is too fast or too slow: it counts, or the trial "
                  "comes again at the end of its block")
          .check(check_limits);
  return schema;
}

/// The keys of [texts] that a question with limits has.
const Schema<TrialQuestion>& limit_text_schema() {
  using Q = TrialQuestion;
  static const auto schema =
      Schema<Q>()
          .shown_text("too_fast", &Q::fast_text,
                      "Text after an answer below the limit `too_fast` of its response")
          .shown_text("too_slow", &Q::slow_text,
                      "Text after an answer above the limit `too_slow` of its response");
  return schema;
}

const Schema<TrialQuestion>& question_name_schema() {
  static const auto schema = Schema<TrialQuestion>().text(
      "name", &TrialQuestion::name, "Name of the question, in formulas and files");
  return schema;
}

const Schema<TrialQuestion>& question_text_schema() {
  static const auto schema =
      Schema<TrialQuestion>()
          .shown_text("question", &TrialQuestion::text, "Text of the question")
          .required();
  return schema;
}

/// @param listed  one of several, which translations tell apart by their names
TrialQuestion read_question(Table& table, Table& root, Means& means, bool listed) {
  TrialQuestion question = question_name_schema().read(table);
  question.most_bytes = record::kAnswerBytes;
  if (listed) {
    table.name_entry(question.name);
  }
  question_text_schema().read(table, question);
  read_answer(table, question, means);
  question_schema().read(table, question);
  if (question.has_limits()) {
    Table texts = root.table("texts");
    limit_text_schema().read(texts, question);
  }
  if (question.name.size() > record::kQuestionBytes) {
    table.reject("name", "too long", fmt::format("at most {} bytes", record::kQuestionBytes));
  }
  return question;
}

}  // namespace

std::vector<std::string> TrialQuestion::answers() const {
  std::vector<std::string> values;
  for (const questions::Choice& choice : choices) {
    values.push_back(choice.value);
  }
  return values.empty() ? std::vector<std::string>{kind->word()} : values;
}

bool TrialQuestion::touched() const {
  return std::ranges::any_of(means, [](const ChoiceMeans& each) { return !each.touch.empty(); });
}

int TrialQuestion::silent_choice() const noexcept {
  const auto found = std::ranges::find_if(means, &ChoiceMeans::silent);
  return found == means.end() ? -1 : static_cast<int>(found - means.begin());
}

bool TrialQuestion::has_limits() const { return too_fast > 0.0 || std::isfinite(too_slow); }

Pace TrialQuestion::pace_of(double reaction_time) const noexcept {
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

void KeyBits::use_characters() {
  constexpr int kAnyCharacter = -1;  // no key has this code
  characters_ = bit_of(kAnyCharacter);
}

std::uint32_t KeyBits::bits_of(const std::vector<int>& held) const {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    if (std::find(held.begin(), held.end(), codes_[i]) != held.end()) {
      bits |= std::uint32_t{1} << i;
    }
  }
  const bool types =
      std::ranges::any_of(held, [](int code) { return code >= ' ' && code < KeyPress::kEscape; });
  return bits == 0 && types ? characters_ : bits;
}

questions::Answer given_answer(const TrialQuestion& question, int choice,
                               const questions::AnswerDraft& draft) {
  return question.has_choices()
             ? questions::Answer{question.first + choice,
                                 question.choices[static_cast<std::size_t>(choice)].value}
             : question.kind->answer(question, draft);
}

std::vector<TrialQuestion> read_questions(Table& root, KeyBits& keys) {
  std::vector<TrialQuestion> questions;
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
      const auto same = [&](const TrialQuestion& each) {
        return each.name == questions.back().name;
      };
      if (std::any_of(questions.begin(), questions.end() - 1, same)) {
        table.reject("name", fmt::format("\"{}\"", questions.back().name),
                     "a name that no other response has");
      }
    }
  }
  return questions;
}

}  // namespace haptrial::protocols
