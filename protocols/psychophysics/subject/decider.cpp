#include "protocols/psychophysics/subject/decider.h"

#include <algorithm>

#include "core/questions/question_kind.h"
#include "core/subject/perceiver/trial_stream.h"

namespace haptrial::protocols {

RandomStream sense_stream(std::uint64_t seed, int trial, int interval) noexcept {
  return subject::trial_stream(seed, interval == 0 ? "sense" : "sense again",
                               trial * static_cast<int>(kMostIntervals) + interval);
}

Decider::Decider(const ObserverPlan& plan, const subject::JudgementParameters& judgement,
                 std::uint64_t session_seed)
    : plan_(plan),
      judgement_(judgement),
      judge_(judgement, session_seed),
      seed_(session_seed),
      other_(subject::trial_stream(session_seed, "other answers", 0)) {}

void Decider::begin_trial(int trial) noexcept {
  judge_.begin_trial(trial);
  other_ = subject::trial_stream(seed_, "other answers", trial);
}

Decider::DecidedAnswer Decider::decide(const TrialQuestion& question, bool first,
                                       std::span<const double> percepts) noexcept {
  DecidedAnswer said;
  if (!question.has_choices()) {
    question.kind->simulate(question, judge_.magnitude(std::max(0.0, percepts.back())), other_,
                            said.draft);
    return said;
  }
  const int most = static_cast<int>(question.choices.size());
  if (first && plan_.decides == Decides::kAdjust) {
    const double wanted = percepts.size() > 1 ? percepts[0] : plan_.wanted;
    const int way = judge_.adjust(percepts.back(), wanted);
    said.choice = way > 0 ? plan_.raise : way < 0 ? plan_.lower : plan_.done;
  } else if (first) {
    decision_ = judged(percepts);
    said.choice = plan_.decides == Decides::kYes
                      ? (decision_.answer == 1 ? plan_.yes : 1 - plan_.yes)
                      : decision_.answer;
  } else {  // a rating of how sure it is
    said.choice = subject::confidence(decision_, judgement_.noise, most) - 1;
  }
  said.choice = std::clamp(said.choice, 0, most - 1);
  if (first) {
    judge_.set_previous(said.choice);
  }
  return said;
}

subject::Decision Decider::judged(std::span<const double> percepts) noexcept {
  if (plan_.decides == Decides::kYes) {
    return judge_.yes_no(percepts.back());
  }
  if (plan_.decides == Decides::kNearest) {
    return judge_.nearest(percepts.back(), plan_.prototypes);
  }
  return judge_.between(percepts, plan_.decides == Decides::kSmallest ? subject::Extreme::kSmallest
                                                                      : subject::Extreme::kLargest);
}

}  // namespace haptrial::protocols
