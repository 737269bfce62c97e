#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/base/key_press.h"
#include "core/questions/question.h"
#include "protocols/psychophysics/definition/mark_means.h"

namespace haptrial::protocols {

/// The keys of the participant's window that a definition uses, a bit of DeviceReading::keys each.
class KeyBits {
 public:
  static constexpr std::size_t kMost = 31;  // the last bit pauses a playback
  /// The bit of a key's code; a new one gets the next. @throws InputError beyond kMost keys
  std::uint32_t bit_of(int code);
  /// From now on every key that types a character has a bit: the same one for all that have none
  /// of their own. @throws InputError as above
  void use_characters();
  /// The bits of held keys; keys that nobody asked for have none.
  std::uint32_t bits_of(const std::vector<int>& held) const;

 private:
  std::vector<int> codes_;
  std::uint32_t characters_{0};  // their bit; 0: they are not used
};

/// Trials in which the participant is told whether an answer was right.
enum class Feedback : std::uint8_t { kNever, kPractice, kAlways };

/// How a choice is made in a trial, at once.
struct ChoiceMeans {
  std::string hint;          // "1"; shown before the label; empty: by buttons only
  std::uint32_t keys{0};     // of KeyBits: any of these gives it
  std::uint32_t buttons{0};  // of the device, likewise
  std::string touch{};       // region into which the tip of the tool is moved; empty: none
  double pedal{0.0};         // depth of an analog pedal from which on it gives it; 0: it does not
  bool silent{false};        // no answer within the question's timeout gives it
};

/// Most choices of a question that are given by touch.
inline constexpr std::size_t kMostTouched = 8;

/// Time of an answer relative to its limits.
enum class Pace : std::uint8_t { kInTime, kTooFast, kTooSlow };

/// A key that an answer hears in a trial.
struct HeardBit {
  std::uint32_t bit{0};  // of KeyBits
  int key{0};            // KeyPress::key
};

/// A question to the participant after the last interval. Its name is that in /responses and in
/// formulas. A question with choices is answered at once, by the means of one of them; all others
/// by the keys of their kind, and ended with enter.
struct TrialQuestion : questions::Question {
  TrialQuestion() { name = "answer"; }

  std::vector<ChoiceMeans> means;  // (choices)
  double first{1.0};            // what formulas take choice 0 for; each further one counts 1 more
  std::vector<HeardBit> heard;  // without choices, enter last
  MarkMeans mark;               // of a kind that marks
  std::string correct;          // formula: the number of the right choice, or its word; empty: none
  Feedback feedback{Feedback::kNever};
  double timeout{0.0};    // then the silent choice is given, or the trial aborted; 0: never [s]
  std::string onset;      // stage of the last interval from whose beginning the reaction counts;
                          // empty: from the question
  double touch_for{0.2};  // the tip stays in the region for it [s]
  double too_fast{0.0};   // an answer before it is told so [s]
  double too_slow{std::numeric_limits<double>::infinity()};  // an answer after it, likewise [s]
  bool again{false};  // the trial of such an answer comes again at the end of its block
  std::string fast_text{"Too fast"}, slow_text{"Too slow"};  // what is told

  bool has_choices() const { return !choices.empty(); }
  /// Whether formulas know the answer by its name.
  bool is_number() const { return has_choices() || low < high; }
  bool touched() const;                // whether a choice is given by touch
  int silent_choice() const noexcept;  // that no answer gives; -1: none
  bool has_limits() const;             // whether an answer can be too fast or too slow
  /// @param reaction_time  [s]; NaN is in time
  Pace pace_of(double reaction_time) const noexcept;
  /// Each answer that has a marker of its own: the choices, or the word of the kind.
  std::vector<std::string> answers() const;
};

/// An answer as /responses has it. @param choice  from 0, of a question with choices
/// @param draft  complete, of any other
questions::Answer given_answer(const TrialQuestion& question, int choice,
                               const questions::AnswerDraft& draft);

/// Reads [response], or several [[responses]]; without either, nothing is asked. Keys in brackets
/// are optional.
///
///     [name]       "answer" if left out; unlike every other's
///     question     the text
///     choices      [{ value, [label], [keys], [buttons], [touch], [pedal], [silent] }, …], or
///     scale        [lowest, highest]: whole numbers, by the keys of their digits, or
///     scale        with step, ends or by: a mark is moved by the arrow keys, as on a page, or
///                  by the hand or the mouse (mark_means.h)
///     number       [lowest, highest]: typed, or
///     words        true: any words, typed, or the key of a kind that a program adds
///     [correct]    formula of the right choice: its number, from 1, or its value as a word
///     [feedback]   "never" (as if left out), "practice" or "always"
///     [timeout]    then the silent choice is given; if there is none, the trial is aborted [s]
///     [reaction_time_from]   a stage
///     [touch_for]  how long the tip stays in a region that is touched [s]
///     [too_fast], [too_slow]   limits of the reaction time [s]; the participant reads
///                  texts.too_fast or texts.too_slow
///     [out_of_time]  of answers beyond them: "go on" (as if left out), or "repeat", the trial at
///                  the end of its block
/// Choices without keys, buttons, touch and pedal have the keys 1, 2, … and the buttons 0, 1, …;
/// a silent one has none.
std::vector<TrialQuestion> read_questions(Table& root, KeyBits& keys);

}  // namespace haptrial::protocols
