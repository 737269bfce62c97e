#include "protocols/bone_drilling/bone_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"
#include "core/subject/drilling/work_row.h"
#include "protocols/bone_drilling/bone_restore.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/stage_stills.h"
#include "protocols/bone_drilling/drilling_rig.h"
#include "protocols/bone_drilling/tuning_page.h"

namespace haptrial::protocols {
namespace {

// Shares of the time until the first picture, when the simulator is there and when the surface is
// begun.
constexpr double kUntilDepths = 0.2;
constexpr double kUntilSurface = 0.5;

/// How many bones a trial has had in earlier runs.
std::int32_t bones_used(const SessionFile& file, const PlannedTrial& trial) {
  std::int32_t most = 0;
  for (const record::PassRow& pass : file.earlier_passes()) {
    most = pass.trial == trial.trial ? std::max(most, pass.repetition) : most;
  }
  return most;
}

}  // namespace

std::vector<PlannedTrial> procedures_of(const BoneDefinition& d, const SessionPlace& place) {
  std::vector<PlannedTrial> plan;
  if (d.practice > 0.0 && place.real && place.session == 1) {
    plan.push_back({0, 0, 1, "practice", derived_seed(place.session_seed, "practice"), true});
  }
  for (int trial = 1; trial <= d.procedures_in(place.session); ++trial) {
    const std::uint64_t seed = derived_seed(place.session_seed, fmt::format("procedure {}", trial));
    plan.push_back(
        {trial, trial, 1, d.condition({trial, place.participant, place.session}), seed, false});
  }
  return plan;
}

BoneTrials::BoneTrials(const BoneDefinition& definition, const SessionPlace& place)
    : d_(definition),
      place_(place),
      plan_(procedures_of(definition, place)),
      injuries_(definition, place.real) {
  if (d_.bones.empty()) {
    throw InputError(fmt::format("{}: has no bones to drill", d_.file_name));
  }
  for (const auto& model : d_.bones) {
    records_.push_back(bone::record_of(*model, static_cast<std::int32_t>(records_.size())));
  }
  if (d_.surgeon && !place.real) {
    work_ = std::make_unique<subject::WorkLog>();
  }
  if (const auto page = page_of<TuningPage>(place.auxiliary_pages)) {
    tuning_ = page->tuning();
  }
  sound_ = std::make_unique<TrialSound>(d_, place, tuning_);
  burrs_ = burr_rows(d_.simulator.tools);
  if (d_.nerves) {
    nerves_ = std::make_unique<TrialNerves>(d_, place, sound_->nerves());
    logs_.watch_nerves(&nerves_->beside());
  }
  if (d_.hints) {
    hints_ = std::make_unique<TrialHints>(d_, place.real, sound_->hints());
  }
  for (const auto& bone : d_.bones) {  // before there is a window: it takes seconds
    stills_.push_back(place.window ? screen_stills(d_, *bone) : nullptr);
  }
  depths_.resize(d_.bones.size());
  if (place.frames_per_pass > 0) {
    pictures_ = std::make_unique<BonePictures>(d_, place.frames_per_pass);
  }
  keep_logs();
}

/// Each part of a definition that has rows of its own stands here and, if its rows come with every
/// tick, is watched from here on.
void BoneTrials::keep_logs() {
  kept_.keep(logs_.tool);
  kept_.keep<record::RemovalRow>(
      logs_.removals, record::table_of<record::RemovalRow>(),
      [this](SessionFile& file, auto rows) { injuries_.add(file, rows); });
  kept_.keep(logs_.camera);
  kept_.keep(logs_.splits);
  if (!d_.simulator.soft_tissue.empty()) {
    kept_.keep<record::TearRow>(
        logs_.tears, record::table_of<record::TearRow>(),
        [this](SessionFile& file, auto rows) { injuries_.add(file, rows); });
  }
  if (d_.osteotomy) {
    logs_.watch_pieces();
    kept_.keep(logs_.pieces);
    kept_.keep(logs_.screws);
  }
  if (d_.drilling.second) {
    logs_.watch_second();
    kept_.keep(logs_.second);
  }
  if (d_.tools_meet()) {
    logs_.watch_tool_contact();
    kept_.keep(logs_.tool_contact);
  }
  if (d_.has_handpiece()) {
    logs_.watch_handpiece();
    kept_.keep(logs_.handpiece);
  }
  if (!d_.simulator.bleeding.structures.empty()) {
    kept_.keep<record::OpeningRow>(logs_.openings, record::table_of<record::OpeningRow>(),
                                   [this](SessionFile& file, auto rows) {
                                     file.add(rows);
                                     openings_ += rows.size();
                                   });
  }
  if (d_.forbidden) {
    kept_.keep(logs_.crossings);
  }
  if (tuning_) {
    kept_.keep<TakenTuning>(logs_.tunings, record::table_of<record::TuningRow>(),
                            [this](SessionFile& file, auto taken) { tell_tuning(file, taken); });
  }
}

std::vector<stimulus::Observer*> BoneTrials::observers() {
  std::vector<stimulus::Observer*> all;
  if (pictures_) {
    all.push_back(pictures_.get());
  }
  if (sound_->observer() != nullptr) {
    all.push_back(sound_->observer());
  }
  return all;
}

std::vector<std::string> BoneTrials::notices() const {
  std::vector<std::string> notices;
  if (!sound_->trouble().empty()) {
    notices.push_back(sound_->trouble());
  }
  for (const auto& bone : d_.bones) {
    if (!bone::has_vital_structures(*bone)) {
      notices.push_back(
          fmt::format("vital structures of '{}' are unknown: it has none by a known "
                      "name, so no injury can be told",
                      bone->name));
    }
  }
  if (openings_ > 0) {
    notices.push_back(fmt::format("{} opened and bled (/openings, /field)",
                                  counted(openings_, "place was", "places were")));
  }
  if (const std::uint64_t tears = injuries_.tears(); tears > 0) {
    notices.push_back(fmt::format("soft tissue was torn {} (/tears)",
                                  tears == 1 ? "once" : fmt::format("{} times", tears)));
  }
  if (tuned_ > 0) {
    notices.push_back(fmt::format(
        "the pilot was tuned by {} (/tuning); the definition that the file keeps is that "
        "of the beginning",
        counted(tuned_, "change", "changes")));
  }
  return notices;
}

std::span<const record::Phase> BoneTrials::phases() const {
  static constexpr std::array kPhases{record::kDrillingPhase};
  return kPhases;
}

record::TableList BoneTrials::tables() const {
  record::TableList tables = record::with_tables(record::drilling_tables(), kept_.tables());
  if (d_.nerves) {
    tables = record::with_tables(tables, record::nerve_tables());
  }
  if (d_.hints) {
    tables = record::with_tables(tables, record::hint_tables());
  }
  tables.push_back(&record::table_of<record::BurrRow>());
  if (d_.has_field()) {
    tables.push_back(&record::table_of<record::FieldRow>());
  }
  if (work_) {
    tables.push_back(&record::table_of<record::WorkRow>());
  }
  return tables;
}

std::vector<record::Rows> BoneTrials::first_rows() const {
  std::vector<record::Rows> rows = record::rows_of(records_);
  rows.emplace_back(std::span(burrs_));
  if (nerves_) {
    rows.emplace_back(nerves_->channels());
  }
  if (hints_) {
    rows.emplace_back(hints_->limits());
  }
  return rows;
}

std::unique_ptr<Rig> BoneTrials::virtual_rig() const {
  return std::make_unique<DrillingRig>(d_, place_, work_.get());
}

void BoneTrials::empty_logs(SessionFile& file) {
  kept_.empty(file);
  tell_shared(file);
  if (hints_) {
    hints_->beside().settle();  // so that the rows up to the last tick are there
    tell_hints(file);
  }
  if (nerves_) {
    nerves_->write(file);
  }
}

void BoneTrials::tell_hints(SessionFile& file) {
  const std::vector<record::HintRow> rows = hints_->beside().take();
  file.add(std::span(rows));
}

void BoneTrials::tell_tuning(SessionFile& file, std::span<const TakenTuning> taken) {
  const std::vector<record::TuningRow> rows = tuning_->rows_of(taken);
  tuned_ += rows.size();
  file.add(std::span(rows));
}

/// What the virtual surgeon worked on in a pass.
void BoneTrials::tell_work(SessionFile& file, std::int32_t pass) {
  std::vector<record::WorkRow> rows;
  for (const subject::BegunWork& begun : work_->take()) {
    rows.push_back({pass, begun.time, begun.work});
  }
  file.add(std::span<const record::WorkRow>(rows));
}

SharedSimulation* BoneTrials::share_world(bool leads) {
  if (tuning_) {
    throw InputError(
        "--side-page tuning is given in a session that is linked to another, which would drill "
        "another bone; leave it out");
  }
  if (d_.hints) {
    throw InputError(fmt::format(
        "{}: has hints, which are given to somebody who drills alone; leave [hints] out of a "
        "session that is linked to another",
        d_.file_name));
  }
  if (d_.forbidden) {
    throw InputError(fmt::format(
        "{}: has forbidden regions, which are given to somebody who drills alone; leave "
        "[forbidden] out of a session that is linked to another",
        d_.file_name));
  }
  if (d_.drilling.second) {
    throw InputError(
        fmt::format("{}: has a second hand, and a bone is shared over a link with one "
                    "hand on each side only; leave [second_hand] out",
                    d_.file_name));
  }
  shared_ = std::make_unique<SharedBone>(leads);
  if (is_led()) {
    kept_.keep(logs_.led);
  }
  return shared_.get();
}

/// Whether the bones of both sides are the same.
void BoneTrials::tell_shared(SessionFile& file) {
  const auto told = shared_ && stage_ ? shared_->attend(*stage_->simulator)
                                      : std::optional<SharedBone::BoneComparison>{};
  if (told) {
    file.event(told->differs ? "bone_differs" : "bone_checked", told->text);
  }
  if (told && told->differs) {
    fmt::print(stderr, "{}\n", told->text);
  }
}

/// A file beside the definition may have changed since: what follows would be of another.
void BoneTrials::check_resumed(const record::SessionReader& file) const {
  if (!file.rows<record::TuningRow>().empty()) {
    throw InputError(fmt::format(
        "{}: was tuned while it ran, and a tuned pilot is not resumed; begin another one with the "
        "definition that was saved on the page",
        file.path().string()));
  }
  if (hints_) {
    hints_->check_resumed(file);
  }
  const std::vector<record::BoneRecord> before = record::recorded_bones(file);
  const std::vector<record::BoneRecord>& now = records_;
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    if (i >= before.size() || i >= now.size() || !bone::same_bone(before[i], now[i])) {
      throw InputError(fmt::format(
          "{}: was recorded with another bone {} ('{}'); resume it with "
          "the same ones",
          file.path().string(), i + 1, i < before.size() ? before[i].bone.name : "none"));
    }
  }
}

void BoneTrials::prepare(const PlannedTrial& trial, SessionFile& file) {
  bone_ = static_cast<std::size_t>(std::max(trial.trial, 1) - 1) % d_.bones.size();
  bones_used_ = bones_used(file, trial);
  stage_.reset();
  if (place_.resumed.empty() || bones_used_ == 0) {
    return;
  }
  if (shared_) {
    begin_again(trial, file);
    return;
  }
  restore(trial, file);
}

/// Each file may have ticks that the other one lost, so that no later bone is known to both sides.
void BoneTrials::begin_again(const PlannedTrial& trial, SessionFile& file) {
  const std::string told = fmt::format(
      "trial {} is done again from its beginning, on both sides, with the bone as it was then",
      trial.trial);
  file.event("bone_anew", told);
  fmt::print(stderr, "{}\n", told);
}

/// The bone of an earlier run of the session, as it stood. The servo loop ticks meanwhile.
void BoneTrials::restore(const PlannedTrial& trial, SessionFile& file) {
  const RestoredBone bone =
      restore_bone(place_.resumed, trial.trial, bones_used_, [&](std::uint64_t tick) {
        place_.pulse("restoring the bone",
                     static_cast<double>(tick) / (d_.rate * d_.drilling.time_limit));
      });
  const bool lost = bone.stage && file.was_cut_short(trial);
  const std::string told =
      bone.told +
      (lost ? "; changes of the last 0.8 s before the interruption may be missing" : "");
  file.event(bone.stage ? "bone_restored" : "bone_lost", told);
  fmt::print(stderr, "{}\n", told);
  if (bone.stage) {
    spent_ = bone.ticks;
    old_dust_ = bone.stage->simulator->removed_so_far();
    set_up(bone.stage, trial);
  }
}

void BoneTrials::begin_attempt(const PlannedTrial& trial, bool anew) {
  const bool fresh = is_led() ? shared_->needs_new_bone() : anew;  // who is led goes by the other
  if (stage_ && !fresh) {
    return;
  }
  pass_.reset();
  led_.reset();
  auto stage = std::make_shared<BoneStage>();
  stage->model = d_.bones[bone_];
  tell_preparing(0.0);
  const geometry::VoxelGrid& grid = stage->model->grid;
  stage->start_view = d_.simulator.camera.start;
  stage->simulator = std::make_unique<bone::Simulator>(*stage->model, simulator_for(d_, grid));
  ++bones_used_;
  spent_ = 0;
  old_dust_ = 0.0;
  set_up(std::move(stage), trial);
}

/// Sets up the parts that go beside a bone.
void BoneTrials::set_up(std::shared_ptr<BoneStage> stage, const PlannedTrial& trial) {
  const geometry::VoxelGrid& grid = stage->model->grid;
  const bone::CompanionParameters companions = companions_for(d_, grid);
  if (place_.real) {
    stage->companions =
        std::make_unique<bone::ThreadedCompanions>(*stage->simulator, companions, !is_led());
  } else {
    stage->companions = std::make_unique<bone::SteppedCompanions>(*stage->simulator, companions,
                                                                  d_.rate, !is_led());
  }
  if (place_.window || pictures_) {
    if (depths_[bone_] == nullptr) {
      tell_preparing(kUntilDepths);
      depths_[bone_] = depths_of(*stage->model);
    }
    stage->depths = depths_[bone_];
  }
  stage->stills = stills_[bone_];
  stage_ = std::move(stage);
  injuries_.begin_bone(*stage_->model, bones_used_);
  if (shared_) {
    shared_->take_new_bone(stage_->simulator->checksum());
  }
  if (nerves_) {
    nerves_->watch(bone_, bones_used_, spent_, trial.stimulus_seed);
  }
  if (hints_) {
    hints_->watch(bone_, *stage_->simulator);
  }
  if (d_.forbidden) {
    guard_ = std::make_unique<RegionGuard>(*d_.forbidden, d_.region_maps[bone_], sound_->regions());
  }
  vibration_.reset();
  if (d_.vibration_gain > 0.0 || tuning_) {
    vibration_.emplace(d_.vibration_table, d_.vibration_gain, d_.rate, trial.stimulus_seed);
  }
  if (tuning_) {
    tuning_->begin(*stage_->simulator, vibration_ ? &*vibration_ : nullptr);
  }
  sound_->listen_to(stage_);
}

void BoneTrials::tell_preparing(double share) {
  if (place_.pulse) {
    place_.pulse("preparing the bone", share);
  }
}

/// The stage is made on the session's thread, so that the screen goes on meanwhile.
MakeDrawing BoneTrials::drawing() {
  const auto surface = built_surface(*stage_, [this](double share) {
    tell_preparing(kUntilSurface + (1.0 - kUntilSurface) * share);
    return true;
  });
  return bone_drawing(d_, stage_, surface);
}

Pass& BoneTrials::make_pass(PlannedTrial& trial, const record::Phase&) {
  trial.repetition = bones_used_;
  if (shared_) {
    shared_->prepare_pass(trial.trial);
  }
  if (nerves_) {
    nerves_->beside().let_hear(d_.hears_nerves(place_of(trial)));
  }
  if (hints_) {
    hints_->beside().let_show(d_.sees_hints(place_of(trial)));
  }
  if (pictures_) {
    pictures_->watch(stage_);
  }
  return is_led() ? make_led_pass(trial) : make_drilling_pass(trial);
}

Pass& BoneTrials::make_drilling_pass(const PlannedTrial& trial) {
  DrillingParameters drilling = d_.drilling;
  drilling.time_limit = trial.practice ? d_.practice : drilling.time_limit;
  pass_ = std::make_unique<DrillingPass>(*stage_->simulator, *stage_->companions, drilling, logs_,
                                         d_.rate, spent_, vibration_ ? &*vibration_ : nullptr,
                                         exposures());
  if (shared_) {
    pass_->share(*shared_);
  }
  if (hints_) {
    pass_->give(hints_->beside());
  }
  if (tuning_) {
    pass_->tune_by(*tuning_);
  }
  if (guard_) {
    guard_->begin_pass(d_.has_regions(place_of(trial)));
    pass_->keep_out(*guard_);
  }
  return *pass_;
}

Pass& BoneTrials::make_led_pass(const PlannedTrial& trial) {
  led_ = std::make_unique<LedPass>(
      LedPass::Parts{*stage_->simulator, *stage_->companions, d_.drilling, logs_, *shared_, d_.rate,
                     trial.trial, place_.real, exposures(), vibration_ ? &*vibration_ : nullptr});
  return *led_;
}

void BoneTrials::close_pass(SessionFile& file, std::int32_t row) {
  spent_ = pass_ ? pass_->ticks() : 0;
  if (led_) {
    led_->rest();
  }
  if (hints_) {
    hints_->beside().end_pass();
    tell_hints(file);
  }
  if (guard_) {
    guard_->end_pass(logs_);
    kept_.empty(file);
  }
  stage_->companions->settle();
  record::ProcedureRow procedure = procedure_of(*stage_, row, static_cast<std::int32_t>(bone_));
  procedure.fallen += old_dust_;
  file.add(std::span<const record::ProcedureRow>(&procedure, 1));
  if (d_.has_field()) {
    const record::FieldRow field = field_of(*stage_, row);
    file.add(std::span<const record::FieldRow>(&field, 1));
  }
  if (work_) {
    tell_work(file, row);
  }
}

void BoneTrials::draw_pictures(const PlannedTrial& trial, const record::Phase&) {
  if (pictures_) {
    pictures_->write(place_.frames_folder,
                     fmt::format("{}-trial{:02}-drilling", place_.subject, trial.trial));
  }
}

}  // namespace haptrial::protocols
