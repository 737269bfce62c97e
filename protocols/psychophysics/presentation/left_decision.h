#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/questions/question.h"

namespace haptrial::protocols {

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
