#include "experiments/bone_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/random.h"
#include "experiments/bone_display.h"
#include "experiments/bone_record.h"
#include "experiments/bone_restore.h"
#include "experiments/drilling_rig.h"
#include "experiments/interrupt.h"
#include "experiments/progress.h"
#include "experiments/session_record.h"
#include "experiments/stage_stills.h"

namespace haptrial::experiments {

BoneTrials::BoneTrials(const SessionRequest& request, std::uint64_t session_seed)
    : request_(request), d_(*request.bone), session_seed_(session_seed) {
  if (d_.bones.empty()) {
    throw InputError(fmt::format("{}: has no bones to drill", d_.file_name));
  }
  if (d_.sound_card && request.clock == realtime::ClockKind::kReal) {
    try {
      sound_ = std::make_unique<BoneSound>(d_, derived_seed(session_seed, "sound"));
    } catch (const RunError& error) {
      notice_ = error.what();
    }
  }
  for (const auto& bone : d_.bones) {  // before there is a window: it takes seconds
    stills_.push_back(request.window ? screen_stills(d_, *bone) : nullptr);
  }
  if (request.frames_per_pass > 0) {
    pictures_ = std::make_unique<BonePictures>(d_, request.frames_per_pass);
  }
}

std::vector<stimulus::Observer*> BoneTrials::observers() {
  std::vector<stimulus::Observer*> all;
  if (pictures_) {
    all.push_back(pictures_.get());
  }
  if (sound_) {
    all.push_back(sound_.get());
  }
  return all;
}

std::vector<std::string> BoneTrials::notices() const {
  return notice_.empty() ? std::vector<std::string>{} : std::vector{notice_};
}

/// People practise; whoever is virtual has nothing to learn from it.
bool BoneTrials::practises() const {
  return d_.practice > 0.0 && request_.clock == realtime::ClockKind::kReal;
}

std::vector<protocols::PlannedTrial> BoneTrials::plan() const {
  std::vector<protocols::PlannedTrial> plan;
  if (practises()) {
    plan.push_back({0, 0, 1, "practice", derived_seed(session_seed_, "practice"), true});
  }
  for (int trial = 1; trial <= d_.design.trials; ++trial) {
    const std::uint64_t seed = derived_seed(session_seed_, fmt::format("procedure {}", trial));
    plan.push_back({trial, trial, 1, "drilling", seed, false});
  }
  return plan;
}

std::span<const record::Phase> BoneTrials::phases() const {
  static constexpr std::array kPhases{record::Phase::kDrilling};
  return kPhases;
}

std::optional<std::vector<record::BoneRecord>> BoneTrials::bones() const {
  std::vector<record::BoneRecord> records;
  for (const auto& model : d_.bones) {
    records.push_back(record_of(*model, static_cast<std::int32_t>(records.size())));
  }
  return records;
}

std::unique_ptr<Rig> BoneTrials::virtual_rig(std::uint64_t session_seed) const {
  return std::make_unique<DrillingRig>(d_, session_seed, request_.participant);
}

void BoneTrials::prepare(const protocols::PlannedTrial& trial, SessionRecord& record) {
  bone_ = static_cast<std::size_t>(std::max(trial.trial, 1) - 1) % d_.bones.size();
  bones_used_ = record.bones_used(trial);
  stage_.reset();
  if (request_.resume && bones_used_ > 0) {
    restore(trial, record);
  }
}

/// The bone of an earlier run of the session, as it stood. The servo loop ticks meanwhile.
void BoneTrials::restore(const protocols::PlannedTrial& trial, SessionRecord& record) {
  const std::filesystem::path session = request_.file.string() + ".partial";
  Progress progress("restoring the bone", d_.rate * d_.drilling.time_limit);
  const RestoredBone bone =
      restore_bone(session, trial.trial, bones_used_, [&](std::uint64_t tick) {
        record.collect([](std::span<const record::Sample>) {});
        progress.update(static_cast<double>(tick), "", d_.rate);
        if (interrupted() || (request_.cancel != nullptr && request_.cancel->load())) {
          throw RunError(fmt::format(
              "interrupted; what was recorded is in {}; continue with --resume", session.string()));
        }
      });
  const bool lost = bone.stage && record.was_cut_short(trial);
  const std::string told =
      bone.told +
      (lost ? "; changes of the last 0.8 s before the interruption may be missing" : "");
  record.event(bone.stage ? "bone_restored" : "bone_lost", told);
  fmt::print(stderr, "{}\n", told);
  if (bone.stage) {
    spent_ = bone.ticks;
    old_dust_ = bone.stage->simulator->removed_so_far();
    set_up(bone.stage, trial);
  }
}

void BoneTrials::begin_attempt(const protocols::PlannedTrial& trial, bool anew) {
  if (stage_ && !anew) {
    return;
  }
  pass_.reset();
  auto stage = std::make_shared<BoneStage>();
  stage->model = d_.bones[bone_];
  const geometry::VoxelGrid& grid = stage->model->grid;
  stage->start_view = d_.simulator.camera.start;
  stage->simulator = std::make_unique<bone::Simulator>(*stage->model, simulator_for(d_, grid));
  ++bones_used_;
  spent_ = 0;
  old_dust_ = 0.0;
  set_up(std::move(stage), trial);
}

/// What goes beside a bone.
void BoneTrials::set_up(std::shared_ptr<BoneStage> stage, const protocols::PlannedTrial& trial) {
  const geometry::VoxelGrid& grid = stage->model->grid;
  const bone::CompanionParameters companions = companions_for(d_, grid);
  if (request_.clock == realtime::ClockKind::kReal) {
    stage->companions = std::make_unique<bone::ThreadedCompanions>(*stage->simulator, companions);
  } else {
    stage->companions =
        std::make_unique<bone::SteppedCompanions>(*stage->simulator, companions, d_.rate);
  }
  if (request_.window || pictures_) {
    stage->depths = depths_of(*stage->model);
  }
  stage->stills = stills_[bone_];
  stage_ = std::move(stage);
  vibration_.reset();
  if (d_.vibration_gain > 0.0) {
    vibration_.emplace(d_.vibration_table, d_.vibration_gain, d_.rate, trial.stimulus_seed);
  }
  if (sound_) {
    sound_->listen_to(stage_);
  }
}

void BoneTrials::show(Screen& screen) { screen.show(bone_drawing(d_, stage_)); }

protocols::Pass& BoneTrials::make_pass(protocols::PlannedTrial& trial, record::Phase,
                                       SessionRecord& record) {
  trial.repetition = bones_used_;
  protocols::DrillingParameters drilling = d_.drilling;
  drilling.time_limit = trial.practice ? d_.practice : drilling.time_limit;
  pass_ = std::make_unique<protocols::DrillingPass>(*stage_->simulator, *stage_->companions,
                                                    drilling, record.drilling_logs(), d_.rate,
                                                    spent_, vibration_ ? &*vibration_ : nullptr);
  if (pictures_) {
    pictures_->watch(stage_);
  }
  return *pass_;
}

void BoneTrials::close_pass(SessionRecord& record, std::int32_t row) {
  spent_ = pass_->ticks();
  stage_->companions->settle();
  const bone::Simulator& simulator = *stage_->simulator;
  const bone::DustBalance dust = stage_->companions->dust();
  record::ProcedureRow procedure;
  procedure.pass = row;
  procedure.bone = static_cast<std::int32_t>(bone_);
  procedure.pieces = simulator.pieces();
  procedure.emptied = simulator.emptied_so_far();
  procedure.before = simulator.amount_at_start();
  procedure.left = simulator.amount_left();
  procedure.cut = simulator.cut_so_far();
  procedure.dust = dust.lying + dust.held;
  procedure.suctioned = dust.suctioned;
  procedure.fallen = dust.fallen + old_dust_;
  procedure.checksum = simulator.checksum();
  record.keep_procedure(procedure);
}

void BoneTrials::draw_pictures(const protocols::PlannedTrial& trial, record::Phase) {
  if (pictures_) {
    pictures_->write(request_.frames_folder,
                     fmt::format("{}-trial{:02}-drilling", request_.subject, trial.trial));
  }
}

}  // namespace haptrial::experiments
