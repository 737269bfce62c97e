#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/subject/drilling/surgeon_work.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_pictures.h"
#include "protocols/bone_drilling/display/bone_stage.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "protocols/bone_drilling/led_pass.h"
#include "protocols/bone_drilling/procedure_rows.h"
#include "protocols/bone_drilling/shared_bone.h"
#include "protocols/bone_drilling/trial_companions.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// The procedures of a session. People practise before the first of their first session; whoever is
/// virtual has nothing to learn from it.
std::vector<PlannedTrial> procedures_of(const BoneDefinition& definition,
                                        const SessionPlace& place);

/// One procedure on a bone (Morris 2006, §3). Where it is broken off, the next attempt goes on with
/// the bone as it is, unless it is to be done anew.
class BoneTrials final : public Trials {
 public:
  /// @param definition, place  outlive the trials
  BoneTrials(const BoneDefinition& definition, const SessionPlace& place);

  Extent extent(int most) const override { return plan_.extent(most); }
  std::optional<PlannedTrial> next(const Outcome*) override { return plan_.next(); }
  bool presents_aborted_again() const override { return true; }
  std::span<const record::Phase> phases() const override;
  std::unique_ptr<Rig> virtual_rig() const override;
  std::vector<stimulus::Observer*> observers() override;
  TickLog* tick_log() override { return &logs_; }
  void empty_logs(SessionFile& file) override;
  std::uint64_t dropped() const override {
    return kept_.dropped() + (nerves_ ? nerves_->beside().dropped() : 0) +
           (hints_ ? hints_->beside().dropped() : 0);
  }
  std::vector<std::string> take_warnings() override { return injuries_.take_warnings(); }
  record::TableList tables() const override;
  std::vector<record::Rows> first_rows() const override;
  void check_resumed(const record::SessionReader& file) const override;
  void prepare(const PlannedTrial& trial, SessionFile& file) override;
  void begin_attempt(const PlannedTrial& trial, bool anew) override;
  MakeDrawing drawing() override;
  /// Whether a pass waits for the first picture: a participant sees the bone from the first tick
  /// on.
  bool waits_for_picture() const override { return true; }
  Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) override;
  void close_pass(SessionFile& file, std::int32_t row) override;
  void draw_pictures(const PlannedTrial& trial, const record::Phase& phase) override;
  SharedSimulation* share_world(bool leads) override;
  std::vector<std::string> notices() const override;
  std::string why_aborted() const override { return "the procedure was broken off"; }

 private:
  void tell_preparing(double share);
  void keep_logs();
  void tell_hints(SessionFile& file);
  void tell_tuning(SessionFile& file, std::span<const TakenTuning> taken);
  void tell_work(SessionFile& file, std::int32_t pass);
  void restore(const PlannedTrial& trial, SessionFile& file);
  static void begin_again(const PlannedTrial& trial, SessionFile& file);
  nerve::NerveExposures* exposures() { return nerves_ ? nerves_->exposures() : nullptr; }
  ProcedurePlace place_of(const PlannedTrial& trial) const {
    return {trial.trial, place_.participant, place_.session};
  }
  bool is_led() const { return shared_ && !shared_->leads(); }
  Pass& make_drilling_pass(const PlannedTrial& trial);
  Pass& make_led_pass(const PlannedTrial& trial);
  void tell_shared(SessionFile& file);
  void set_up(std::shared_ptr<BoneStage> stage, const PlannedTrial& trial);

  const BoneDefinition& d_;
  const SessionPlace& place_;
  std::unique_ptr<subject::WorkLog> work_;  // of a virtual surgeon on a simulated clock; else null
  FixedPlan plan_;
  DrillingLogs logs_;
  KeptLogs kept_;  // of these
  NotedInjuries injuries_;
  std::vector<record::BoneRecord> records_;  // of the bones
  std::vector<record::BurrRow> burrs_;
  std::unique_ptr<TrialNerves> nerves_;  // null: nobody watches any
  std::unique_ptr<TrialSound> sound_;
  std::shared_ptr<LiveTuning> tuning_;  // by the page of a pilot; null: there is none
  std::uint64_t tuned_{0};              // changes that were taken
  std::unique_ptr<TrialHints> hints_;   // null: none are given
  std::unique_ptr<RegionGuard> guard_;  // of the bone; null: no region is forbidden
  std::unique_ptr<BonePictures> pictures_;
  std::shared_ptr<BoneStage> stage_;
  std::size_t bone_{0};         // of the definition's
  std::int32_t bones_used_{0};  // in this trial, earlier runs of the session included
  std::vector<std::shared_ptr<const std::vector<render::Image>>> stills_;  // by bone
  std::vector<std::shared_ptr<const bone::StructureDepths>> depths_;       // by bone, once needed
  std::uint64_t spent_{0};  // ticks of the time limit
  double old_dust_{0.0};    // made in earlier runs of the session, which nobody follows [voxels]
  std::optional<sound::DrillVibration> vibration_;
  std::uint64_t openings_{0};           // of vessels, in this run
  std::unique_ptr<SharedBone> shared_;  // with a linked session; null: it is nobody else's
  std::unique_ptr<DrillingPass> pass_;
  std::unique_ptr<LedPass> led_;  // in its stead, on a bone that belongs to the other side
};

}  // namespace haptrial::protocols
