#pragma once

#include <atomic>
#include <memory>

#include "experiments/bone_definition.h"
#include "experiments/bone_pictures.h"
#include "experiments/bone_sound.h"
#include "experiments/bone_stage.h"
#include "experiments/trials.h"
#include "protocols/drilling_pass.h"

namespace haptrial::experiments {

/// One procedure on a bone (Morris 2006, §3). Where it is broken off, the next attempt goes on with
/// the bone as it is, unless it is to be done anew.
class BoneTrials final : public Trials {
 public:
  BoneTrials(const SessionRequest& request, std::uint64_t session_seed);

  std::vector<protocols::PlannedTrial> plan() const override;
  std::span<const record::Phase> phases() const override;
  std::optional<std::vector<record::BoneRecord>> bones() const override;
  std::unique_ptr<Rig> virtual_rig(std::uint64_t session_seed) const override;
  std::vector<stimulus::Observer*> observers() override;
  void prepare(const protocols::PlannedTrial& trial, SessionRecord& record) override;
  void begin_attempt(const protocols::PlannedTrial& trial, bool anew) override;
  void show(Screen& screen) override;
  protocols::Pass& make_pass(protocols::PlannedTrial& trial, record::Phase phase,
                             SessionRecord& record) override;
  std::shared_ptr<const bone::BoneModel> bone() const override { return stage_->model; }
  void close_pass(SessionRecord& record, std::int32_t row) override;
  void draw_pictures(const protocols::PlannedTrial& trial, record::Phase phase) override;
  std::vector<std::string> notices() const override;
  const char* why_aborted() const override { return "the procedure was broken off"; }

 private:
  bool practises() const;
  void restore(const protocols::PlannedTrial& trial, SessionRecord& record);
  void set_up(std::shared_ptr<BoneStage> stage, const protocols::PlannedTrial& trial);

  const SessionRequest& request_;
  const BoneDefinition& d_;
  std::uint64_t session_seed_;
  std::unique_ptr<BonePictures> pictures_;
  std::shared_ptr<BoneStage> stage_;
  std::size_t bone_{0};         // of the definition's
  std::int32_t bones_used_{0};  // in this trial, earlier runs of the session included
  std::vector<std::shared_ptr<const std::vector<render::Image>>> stills_;  // by bone
  std::uint64_t spent_{0};  // ticks of the time limit
  double old_dust_{0.0};    // made in earlier runs of the session, which nobody follows [voxels]
  std::optional<sound::DrillVibration> vibration_;
  std::unique_ptr<BoneSound> sound_;
  std::string notice_;
  std::unique_ptr<protocols::DrillingPass> pass_;
};

}  // namespace haptrial::experiments
