#include "protocols/force_training/force_trials.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "protocols/force_training/guided_passes.h"
#include "protocols/force_training/path_drawing.h"
#include "protocols/force_training/recorded_pass.h"
#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/virtual_rig.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {

ForceTrials::ForceTrials(const ForceDefinition& definition, const SessionPlace& place)
    : d_(definition),
      place_(place),
      plan_(planned_trials_of(d_, place)),
      pictures_(d_.display, place),
      expert_(d_.shows_expert() ? std::make_unique<ExpertLog>() : nullptr) {}

std::span<const record::Phase> ForceTrials::phases() const { return passes_of(d_, place_.session); }

std::unique_ptr<Rig> ForceTrials::virtual_rig() const {
  return std::make_unique<VirtualRig>(d_, place_.hand_person_seed, place_.hand_session_seed,
                                      earlier_lessons(d_, place_));
}

std::vector<stimulus::Observer*> ForceTrials::observers() {
  std::vector<stimulus::Observer*> all;
  if (pictures_.observer() != nullptr) {
    all.push_back(pictures_.observer());
  }
  return all;
}

record::TableList ForceTrials::tables() const {
  return expert_ ? record::TableList{&record::table_of<record::TutoringRow>()}
                 : record::TableList{};
}

void ForceTrials::check_resumed(const record::SessionReader& file) const {
  if (d_.trajectory.from.empty()) {
    return;
  }
  constexpr double kSame = 1e-6;  // [m]
  const stimulus::Stimulus now = stimulus::make_stimulus(d_.trajectory, d_.force_pattern, 1);
  for (const record::StimulusRow& row : file.stimuli()) {
    if ((now.path.at(row.time).position - row.position).norm() > kSame) {
      throw InputError(
          fmt::format("{}: was recorded along another path than that of trajectory.from, {}, is "
                      "now; resume it with the same recording",
                      file.path().string(), d_.trajectory.from));
    }
  }
}

void ForceTrials::empty_logs(SessionFile& file) {
  if (expert_) {
    expert_->flush([&file](std::span<const record::TutoringRow> rows) { file.add(rows); });
  }
}

void ForceTrials::prepare(const PlannedTrial& trial, SessionFile& file) {
  if (!stimulus_ || stimulus_seed_ != trial.stimulus_seed) {
    stimulus_ = stimulus::make_stimulus(d_.trajectory, d_.force_pattern, trial.stimulus_seed);
    stimulus_seed_ = trial.stimulus_seed;
    pictures_.set_trajectory(stimulus_->path.points());
  }
  if (!file.holds_stimulus(trial.block)) {
    file.keep_stimulus(trial.block, stimulus_rows(*stimulus_, trial.block, d_.stimulus_rate));
  }
}

MakeDrawing ForceTrials::drawing() { return path_drawing(d_.display, stimulus_->path.points()); }

Pass& ForceTrials::make_pass(PlannedTrial& trial, const record::Phase& phase) {
  pass_ = protocols::make_pass(trial.condition, phase, *stimulus_, d_.guidance, trial.block);
  if (expert_) {
    pass_->record_expert(*expert_);
  }
  return *pass_;
}

std::vector<record::StimulusRow> stimulus_rows(const stimulus::Stimulus& s, std::int32_t block,
                                               double rate) {
  std::vector<record::StimulusRow> rows;
  const double end = s.path.duration();
  const auto add = [&](double t) {
    rows.push_back({block, t, s.path.at(t).position, s.force.at(t)});
  };
  const auto steps = static_cast<std::size_t>(end * rate);
  rows.reserve(steps + 2);
  for (std::size_t i = 0; i <= steps; ++i) {
    add(static_cast<double>(i) / rate);
  }
  constexpr double kRounding = 1e-9;  // [s]
  if (end - rows.back().time > kRounding) {
    add(end);
  }
  return rows;
}

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
