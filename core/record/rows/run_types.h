#pragma once

#include <cstdint>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// How a run of a session stands: from one start of the program to its end.
enum class RunState : std::uint8_t {
  kRunning,  // or it was killed
  kStopped,  // it ended in order, and the session goes on in another run
  kEnded     // as did the session
};

/// Word of a state in /runs.
constexpr const char* name_of(RunState state) noexcept {
  switch (state) {
    case RunState::kStopped:
      return "stopped";
    case RunState::kEnded:
      return "ended";
    case RunState::kRunning:
      break;
  }
  return "running";
}

/// Counts of the loop of one run so far, a row of /runs; the last row of a run counts.
struct RunRow {
  std::int32_t run{1};            // from 1
  std::uint64_t first_sample{0};  // sequence number of its first tick
  TimingSummary counts;           // of this run
  std::int32_t planned{-1};       // trials of the study; -1: not known
  RunState state{RunState::kRunning};
};

/// Facts of a pass that are known when it begins, a row of /begun: a kill in mid-pass would lose
/// them.
struct BegunRow {
  std::int32_t row{0};  // that it gets in /trials
  PassRow pass;         // without its samples and its status
};

}  // namespace haptrial::record
