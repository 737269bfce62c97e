#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/live_figures.h"
#include "protocols/interface/trials.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"

namespace haptrial::protocols {

/// The trials as an experimenter sees them while a session runs: the level, the track, the last
/// answers, how many were correct. Session's thread.
class LiveTrials {
 public:
  /// A trial that is to come. @param running  of its sequence
  void begin(const NextTrial& next, const std::vector<RunningTrack>& running);
  /// Keeps the outcome of the trial.
  void conclude(const Outcome& outcome);
  /// Nothing before the first trial.
  std::optional<record::LiveState> state() const;

 private:
  struct AnsweredTrial {
    std::string condition;
    int track{-1};
    double level{0.0};
    record::ResponseRow first;  // response
    bool practice{false};
  };
  void add_last_answers(record::LiveState& state) const;
  void add_shares(record::LiveState& state) const;
  void add_track(record::LiveState& state) const;

  std::optional<NextTrial> now_;
  std::string track_;     // of the present trial; empty: no procedure is asked
  std::string variable_;  // that it sets
  std::string unit_;      // of the variable
  int reversals_{-1};     // of the track; -1: it is no staircase
  std::vector<AnsweredTrial> answered_;
};

}  // namespace haptrial::protocols
