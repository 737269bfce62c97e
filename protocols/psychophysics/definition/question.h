#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// The keys of the participant's window that a definition uses, a bit of DeviceReading::keys each.
class KeyBits {
 public:
  static constexpr std::size_t kMost = 31;  // the last bit pauses a playback
  /// The bit of a key's code; a new one gets the next. @throws InputError beyond kMost keys
  std::uint32_t bit_of(int code);
  /// The bits of held keys; keys that nobody asked for have none.
  std::uint32_t bits_of(const std::vector<int>& held) const;

 private:
  std::vector<int> codes_;
};

/// Trials in which the participant is told whether an answer was right.
enum class Feedback : std::uint8_t { kNever, kPractice, kAlways };

/// One answer that may be chosen.
struct Choice {
  std::string value;         // what is recorded
  std::string label;         // what is shown
  std::string hint;          // how it is given: "1"; shown before the label; empty: by buttons only
  std::uint32_t keys{0};     // of KeyBits: any of these gives it
  std::uint32_t buttons{0};  // of the device, likewise
  std::string touch{};       // region into which the tip of the tool is moved; empty: none
  double pedal{0.0};         // depth of an analog pedal from which on it gives it; 0: it does not
};

/// Most choices of a question that are given by touch.
inline constexpr std::size_t kMostTouched = 8;

/// Time of an answer relative to its limits.
enum class Pace : std::uint8_t { kInTime, kTooFast, kTooSlow };

/// A question to the participant after the last interval.
struct Question {
  std::string name{"answer"};   // in /responses and in formulas
  std::string text;             // what is read
  std::vector<Choice> choices;  // empty: a number is typed, and ended with enter
  double first{1.0};            // what formulas take choice 0 for; each further one counts 1 more
  double low{0.0}, high{0.0};   // bounds of a typed number
  std::vector<std::uint32_t>
      typing;           // of KeyBits: 0 to 9, ".", backspace, enter; of a typed number
  std::string correct;  // formula: the number of the right choice, or its word; empty: none
  Feedback feedback{Feedback::kNever};
  double timeout{0.0};    // then the trial is aborted; 0: never [s]
  std::string onset;      // stage of the last interval from whose beginning the reaction counts;
                          // empty: from the question
  double touch_for{0.2};  // the tip stays in the region for it [s]
  double too_fast{0.0};   // an answer before it is told so [s]
  double too_slow{std::numeric_limits<double>::infinity()};  // an answer after it, likewise [s]
  bool again{false};  // the trial of such an answer comes again at the end of its block
  std::string fast_text{"Too fast"}, slow_text{"Too slow"};  // what is told

  bool types() const { return choices.empty(); }
  bool touched() const;     // whether a choice is given by touch
  bool has_limits() const;  // whether an answer can be too fast or too slow
  /// @param reaction_time  [s]; NaN is in time
  Pace pace_of(double reaction_time) const noexcept;
  /// Each answer that has a marker of its own: the choices, or "number".
  std::vector<std::string> answers() const;
};

/// Reads [response], or several [[responses]]; without either, nothing is asked. Keys in brackets
/// are optional.
///
///     [name]       "answer" if left out; unlike every other's
///     question     the text
///     choices      [{ value, [label], [keys], [buttons], [touch], [pedal] }, …], or
///     scale        [lowest, highest]: whole numbers, by the keys of their digits, or
///     number       [lowest, highest]: typed
///     [correct]    formula of the right choice: its number, from 1, or its value as a word
///     [feedback]   "never" (as if left out), "practice" or "always"
///     [timeout]    then the trial is aborted [s]
///     [reaction_time_from]   a stage
///     [touch_for]  how long the tip stays in a region that is touched [s]
///     [too_fast], [too_slow]   limits of the reaction time [s]; the participant reads
///                  texts.too_fast or texts.too_slow
///     [out_of_time]  of answers beyond them: "go on" (as if left out), or "repeat", the trial at
///                  the end of its block
/// Choices without keys, buttons, touch and pedal have the keys 1, 2, … and the buttons 0, 1, …
std::vector<Question> read_questions(Table& root, KeyBits& keys);

}  // namespace haptrial::protocols
