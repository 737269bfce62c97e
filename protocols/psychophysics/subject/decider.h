#pragma once

#include <cstdint>
#include <span>

#include "core/base/random.h"
#include "core/subject/perceiver/judgement.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "protocols/psychophysics/subject/observer_plan.h"

namespace haptrial::protocols {

/// The noise of what is felt in an interval. @param trial, interval  from 0
RandomStream sense_stream(std::uint64_t seed, int trial, int interval) noexcept;

/// How a virtual participant answers the questions of a trial from what was felt, with a hand or
/// without one. Servo thread after construction: no allocation, lock, I/O or throw.
class Decider {
 public:
  struct DecidedAnswer {
    int choice{-1};                // from 0; -1: the question has no choices
    questions::AnswerDraft draft;  // of a question without choices
  };
  /// @param plan  outlives it; @param session_seed  the participant's
  Decider(const ObserverPlan& plan, const subject::JudgementParameters& judgement,
          std::uint64_t session_seed);

  void begin_trial(int trial) noexcept;
  /// @param answer  to the first question in the trial before; -1: there is none
  void set_previous(int answer) noexcept { judge_.set_previous(answer); }
  /// The last interval is judged; "largest" and "smallest" compare all, "adjust" the last with the
  /// first. @param percepts  of the intervals, 1 to kMostIntervals
  DecidedAnswer decide(const TrialQuestion& question, bool first,
                       std::span<const double> percepts) noexcept;

 private:
  subject::Decision judged(std::span<const double> percepts) noexcept;

  const ObserverPlan& plan_;
  subject::JudgementParameters judgement_;
  subject::Judge judge_;
  subject::Decision decision_;
  std::uint64_t seed_;
  RandomStream other_;  // of the trial, for answers that follow from nothing felt
};

}  // namespace haptrial::protocols
