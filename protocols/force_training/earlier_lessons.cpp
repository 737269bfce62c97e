#include "protocols/force_training/earlier_lessons.h"

#include <algorithm>

#include "protocols/force_training/guided_passes.h"
#include "protocols/force_training/training_pass.h"

namespace haptrial::protocols {
namespace {

/// The training pass of a block as a perfect hand goes through it.
std::vector<subject::LessonMoment> moments_of(const ForceDefinition& d, const PlannedTrial& trial) {
  const stimulus::Stimulus stimulus =
      stimulus::make_stimulus(d.trajectory, d.force_pattern, trial.stimulus_seed);
  const auto pass = make_training_pass(trial.condition, stimulus, d.guidance, trial.block);
  std::vector<subject::LessonMoment> moments;
  for (int knot = 0; knot < subject::ForceProfile::kKnots; ++knot) {
    PassMoment moment;
    moment.along = (knot + 0.5) / subject::ForceProfile::kKnots * stimulus.path.duration();
    moment.stage = record::Stage::kRun;
    moment.tool = stimulus.path.at(moment.along).position;
    moment.target_force = moment.applied_force = stimulus.force.at(moment.along);
    moments.push_back({pass->presentation(moment), moment.target_force});
  }
  return moments;
}

/// The planned trials of another session of the same participant, without practice.
std::vector<PlannedTrial> scored_trials(const ForceDefinition& d, SessionPlace place, int session) {
  place.session = session;
  std::vector<PlannedTrial> trials = planned_trials_of(d, place);
  std::erase_if(trials, [](const PlannedTrial& trial) { return trial.practice; });
  return trials;
}

}  // namespace

std::vector<subject::Lesson> earlier_lessons(const ForceDefinition& d, const SessionPlace& place) {
  std::vector<subject::Lesson> lessons;
  for (const int session : d.trainings_before(place.session, place.participant)) {
    for (const PlannedTrial& trial : scored_trials(d, place, session)) {
      auto known = std::ranges::find(lessons, trial.block, &subject::Lesson::block);
      if (known == lessons.end()) {
        lessons.push_back({trial.block, 0, 0, moments_of(d, trial)});
        known = lessons.end() - 1;
      }
      ++known->exposures;
      known->sessions_ago = place.session - session;
    }
  }
  return lessons;
}

}  // namespace haptrial::protocols
