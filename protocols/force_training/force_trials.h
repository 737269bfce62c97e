#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/stimulus/stimulus.h"
#include "core/subject/virtual_subject.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/pass_pictures.h"
#include "protocols/force_training/trajectory_pass.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// A training pass and a test pass along a path (Morris 2006, §4).
class ForceTrials final : public Trials {
 public:
  /// @param definition, place  outlive the trials
  ForceTrials(const ForceDefinition& definition, const SessionPlace& place);

  Extent extent(int most) const override { return plan_.extent(most); }
  std::optional<PlannedTrial> next(const Outcome*) override { return plan_.next(); }
  bool presents_aborted_again() const override { return true; }
  std::span<const record::Phase> phases() const override;
  std::unique_ptr<Rig> virtual_rig() const override;
  std::vector<stimulus::Observer*> observers() override;
  /// Tables of the expert, if there is one.
  record::TableList tables() const override;
  /// Refuses a recorded path that is another one by now.
  void check_resumed(const record::SessionReader& file) const override;
  void empty_logs(SessionFile& file) override;
  std::uint64_t dropped() const override { return expert_ ? expert_->dropped() : 0; }
  void prepare(const PlannedTrial& trial, SessionFile& file) override;
  MakeDrawing drawing() override;
  Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) override;
  void draw_pictures(const PlannedTrial& trial, const record::Phase& phase) override {
    pictures_.draw(trial, phase);
  }
  std::string why_aborted() const override {
    return "the tool did not come to the start, or to the end, in time";
  }

 private:
  const ForceDefinition& d_;
  const SessionPlace& place_;
  FixedPlan plan_;
  PassPictures pictures_;
  std::optional<stimulus::Stimulus> stimulus_;
  std::uint64_t stimulus_seed_{0};
  std::unique_ptr<ExpertLog> expert_;  // null without one
  std::unique_ptr<TrajectoryPass> pass_;
};

/// The ideal curves of a block for the session file: evenly at `rate` [Hz], and the end of the run,
/// which may come sooner after the row before.
std::vector<record::StimulusRow> stimulus_rows(const stimulus::Stimulus& stimulus,
                                               std::int32_t block, double rate);

/// Lessons that a virtual participant had in earlier sessions of the blocks of this one; nothing in
/// a first session. The earlier sessions are taken as done as planned by a hand that made no error.
/// @param place  of the session
std::vector<subject::Lesson> earlier_lessons(const ForceDefinition& definition,
                                             const SessionPlace& place);

}  // namespace haptrial::protocols
