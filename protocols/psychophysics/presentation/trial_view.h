#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/questions/question.h"
#include "core/record/rows/answer_rows.h"
#include "protocols/interface/pass.h"
#include "protocols/psychophysics/definition/measure.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/objects/look.h"
#include "protocols/psychophysics/objects/seen_bodies.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::protocols {

/// A place that is shown: a circle about it, or a dot.
struct Mark {
  std::array<float, 3> place{};  // in W [m]
  float radius{0.0F};            // 0: a dot [m]
  std::uint8_t device{0};        // whose tool it is for, from 0
  std::int8_t target{-1};        // of the trial's moving targets, from 0; -1: it stands still
};

/// A stereogram that is shown.
struct DotsShown {
  RandomDots dots;
  std::uint64_t seed{0};
  bool shown{false};
};

enum class Verdict : std::uint8_t { kNone, kRight, kWrong };

/// The participant's view of trials at one instant; the drawing and the virtual participant take it
/// from here.
struct TrialView {
  static constexpr std::size_t kMostMarks = 8;
  static constexpr std::size_t kTyped = record::kAnswerBytes + 1;
  static_assert(kMostTouched <= kMostMarks);

  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};                // of the first device
  std::array<std::array<float, 3>, kMostDevices - 1> others{};  // tools of the others [m]
  std::array<float, 3> cursor{};                                // in W [m]
  std::array<float, 3> cursor_about{};  // place about which it is turned [m]
  DotsShown dots;
  std::array<Mark, kMostMarks> marks{};
  std::array<SeenObject, kMostSeenObjects> objects{};  // those that are seen come first
  SeenForces pressed;                                  // on them
  std::array<char, kTyped> typed{};                    // of an answer, ended by 0
  std::int32_t chosen{-1};                             // likewise: its step; -1: none yet
  std::array<float, kMostMeasures> measured{};         // in their units; NaN: not told
  std::int32_t trial{0};  // of the presentation: changes from trial to trial
  std::uint8_t other_count{0};
  std::uint8_t mark_count{0};
  std::uint8_t interval{0};  // from 1; 0: none
  std::uint8_t stage{0};     // of the interval, from 0
  std::uint8_t question{0};  // from 1; 0: nothing is asked
  Verdict verdict{Verdict::kNone};
  Pace pace{Pace::kInTime};  // of the answer that is told about
  bool hand_shown{false};
  bool cursor_shown{false};
  bool number_shown{false};  // of the interval
  bool refused{false};       // enter was pressed, and the answer is none that is allowed
  bool results{false};       // what was measured is told

  bool engaged() const noexcept { return interval > 0 || question > 0 || results; }
  bool told() const noexcept { return verdict != Verdict::kNone || pace != Pace::kInTime; }
  /// Shows the answer so far. Servo thread: no allocation or throw.
  void show(const questions::AnswerDraft& draft) noexcept {
    chosen = draft.chosen;
    const std::string_view text = cut_text(draft.typed.view(), kTyped - 1);
    typed = {};
    std::ranges::copy(text, typed.begin());
  }
  /// Sets the content of a stage; at most kMostMarks marks. Servo thread: no allocation or throw.
  void show(std::span<const Mark> seen, std::span<const SeenObject> bodies, bool hand, bool number,
            const DotsShown& bar) noexcept {
    hand_shown = hand;
    number_shown = number;
    dots = bar;
    mark_count = static_cast<std::uint8_t>(std::min(seen.size(), kMostMarks));
    std::copy_n(seen.begin(), mark_count, marks.begin());
    objects = {};
    pressed.counts = {};
    std::copy_n(bodies.begin(), std::min(bodies.size(), kMostSeenObjects), objects.begin());
  }
};

/// An answer that a virtual participant gives; a person uses buttons and keys. Written and read on
/// the servo thread.
struct SimulatedAnswer {
  bool given{false};
  int choice{-1};                // from 0; -1: the question has no choices
  questions::AnswerDraft draft;  // of a question without choices
};

/// Most intervals of a trial that a virtual participant compares.
inline constexpr std::size_t kMostIntervals = 16;

/// A decision that a virtual participant leaves to the session's thread, which asks a script. The
/// servo thread asks and goes on; the participant thinks until the answer is there.
class LeftDecision {
 public:
  /// The answer to one question.
  struct Answer {
    int choice{-1};                // from 0; -1: the question has no choices
    questions::AnswerDraft draft;  // of a question without choices
    double reaction{0.0};          // from the question to the answer >= 0 [s]
  };
  struct DecisionRequest {
    std::size_t question{0};                      // from 0
    std::array<double, kMostIntervals> percepts;  // (intervals) [unit of the sense]
    std::size_t intervals{1};
    Answer proposed;  // what the participant would answer
  };

  // Servo thread: no allocation, lock, I/O or throw.
  void ask(const DecisionRequest& asked) noexcept {
    asked_ = asked;
    state_.store(State::kAsked, std::memory_order_release);
  }
  /// Null until there is one.
  const Answer* answer() const noexcept {
    return state_.load(std::memory_order_acquire) == State::kAnswered ? &answer_ : nullptr;
  }
  /// Drops the question, and an answer that is still to come.
  void forget() noexcept { state_.store(State::kNothing, std::memory_order_release); }

  /// Whether an answer is waited for. Any thread.
  bool waits() const noexcept { return state_.load(std::memory_order_acquire) == State::kAsked; }

  // Session's thread, while it waits.
  const DecisionRequest& asked() const noexcept { return asked_; }
  void answer(const Answer& answer) noexcept {
    answer_ = answer;
    State expected = State::kAsked;
    state_.compare_exchange_strong(expected, State::kAnswered, std::memory_order_acq_rel);
  }

 private:
  enum class State : std::uint8_t { kNothing, kAsked, kAnswered };

  std::atomic<State> state_{State::kNothing};
  DecisionRequest asked_{};
  Answer answer_;
};

}  // namespace haptrial::protocols
