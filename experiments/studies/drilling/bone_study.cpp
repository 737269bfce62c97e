#include "experiments/studies/drilling/bone_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/exception_words.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/simulator/companions.h"
#include "core/record/read/session_reader.h"
#include "experiments/preview/tried_trial.h"
#include "experiments/studies/drilling/drilling_curriculum.h"
#include "experiments/studies/drilling/drilling_preview.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/live_drilling.h"
#include "experiments/studies/drilling/trainee_pages.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/drilling_pass.h"

namespace haptrial::experiments {
namespace {

using protocols::BoneDefinition;

constexpr std::uint32_t kPowerButton = 1, kNextButton = 2;

/// The session's, but for buttons that the page alone holds.
protocols::DrillingParameters tried_parameters(const BoneDefinition& d) {
  protocols::DrillingParameters parameters = d.drilling;
  parameters.controls = {};
  parameters.controls.buttons[static_cast<std::size_t>(bone::Function::kPower)] = kPowerButton;
  parameters.controls.buttons[static_cast<std::size_t>(bone::Function::kNextTool)] = kNextButton;
  return parameters;
}

/// Dust and blood are not felt, and the page doesn't draw them.
bone::CompanionParameters without_dust(bone::CompanionParameters parameters) {
  parameters.dusty = false;
  parameters.bleeds = false;
  return parameters;
}

class TriedDrilling final : public TriedPass {
 public:
  TriedDrilling(const BoneDefinition& d, std::size_t bone, const protocols::PlannedTrial& trial)
      : TriedPass(d, d.mouse.start),
        d_(d),
        bone_(bone),
        simulator_(*d.bones[bone], simulator_for(d, d.bones[bone]->grid)),
        companions_(simulator_, without_dust(companions_for(d, d.bones[bone]->grid)), d.rate) {
    if (d.vibration_gain > 0.0) {
      vibration_.emplace(d.vibration_table, d.vibration_gain, d.rate, trial.stimulus_seed);
    }
    auto pass = std::make_unique<protocols::DrillingPass>(simulator_, companions_,
                                                          tried_parameters(d), logs_, d.rate, 0,
                                                          vibration_ ? &*vibration_ : nullptr);
    if (d.forbidden) {
      guard_.emplace(*d.forbidden, d.region_maps[bone], nullptr);
      guard_->begin_pass(d.has_regions({.trial = trial.trial}));
      pass->keep_out(*guard_);
    }
    begin(std::move(pass));
    choose(0);
  }

  std::vector<std::string> stages() const override {
    std::vector<std::string> names;
    for (const bone::ToolSpec& tool : d_.simulator.tools) {
      names.push_back(tool.name + ", at rest");
      names.push_back(tool.name + ", with power");
    }
    return names;
  }
  std::vector<SpaceObject> objects() const override {
    return *objects_of(protocols::placed_bone(d_, bone_), d_.drilling.scale);
  }
  void choose(std::size_t stage) override {
    tool_ = static_cast<int>(stage / 2);
    power_ = stage % 2 == 1 ? kPowerButton : 0;
  }
  std::string now() const override {
    if (is_over()) {
      return "the procedure is over";
    }
    const double voxel = std::pow(1e3 * d_.bones[bone_]->grid.spacing, 3);  // [mm³]
    return fmt::format("{}{}, {:.2f} mm³ of bone removed", simulator_.tool().name,
                       simulator_.output().contact ? " at the bone" : "",
                       voxel * simulator_.removed_so_far());
  }

 private:
  /// A tool comes into the hand each time that the button goes down.
  void before_tick() override {
    const bool presses = simulator_.output().tool != tool_ && !pressed_;
    hold(power_ | (presses ? kNextButton : 0));
    pressed_ = presses;
  }

  const BoneDefinition& d_;
  std::size_t bone_;
  protocols::DrillingLogs logs_;  // never read: what is tried is not kept
  bone::Simulator simulator_;
  bone::SteppedCompanions companions_;
  std::optional<sound::DrillVibration> vibration_;
  std::optional<protocols::RegionGuard> guard_;
  int tool_{0};
  std::uint32_t power_{0};
  bool pressed_{false};
};

/// A procedure on its bone, by the pass of sessions, with each tool at rest and with power. There
/// is no sound, and no hints are given; forbidden regions are felt.
/// @param definition  with its bones; outlives the trial
/// @throws InputError for a procedure beyond the session
std::shared_ptr<TriedTrial> tried_drilling(const BoneDefinition& definition,
                                           const PreviewRequest& request) {
  const protocols::PlannedTrial trial = procedure_of(definition, request);
  return std::make_shared<TriedDrilling>(definition, bone_of(definition, trial), trial);
}

}  // namespace

namespace fs = std::filesystem;
namespace {

using analysis::drilling::Procedure;

/// The drillings of a running session.
class DrillingFigures final : public record::LiveFigures {
 public:
  DrillingFigures(const protocols::BoneDefinition& definition, fs::path resumed)
      : d_(definition),
        resumed_(std::move(resumed)),
        live_(procedure_setup(definition), definition.rate) {}

  void begin_pass(const record::PassRow& pass, std::int32_t) override {
    const auto bone = static_cast<std::size_t>(std::max(pass.trial, 1) - 1) % d_.bones.size();
    live_.begin(pass, d_.bones[bone], of_earlier_run(pass));
  }
  void rows(const record::Rows& batch) override {
    live_.add(batch.as<record::ToolRow>());
    live_.add(batch.as<record::RemovalRow>());
    live_.add(batch.as<record::CameraRow>());
    live_.add(batch.as<record::SplitRow>());
    live_.add(batch.as<record::PieceRow>());
    live_.add(batch.as<record::ScrewRow>());
  }
  void samples(std::span<const record::Sample> samples) override { live_.add(samples); }
  void finish() override { live_.finish(); }
  std::optional<record::LiveState> now() const override {
    const auto procedure = live_.now();
    return procedure ? std::optional(state_of(*procedure)) : std::nullopt;
  }
  std::vector<record::LiveState> done() const override {
    std::vector<record::LiveState> states;
    for (const DrilledProcedure& procedure : live_.procedures()) {
      states.push_back(state_of(procedure));
    }
    return states;
  }
  std::string trouble() const override { return trouble_.empty() ? live_.trouble() : trouble_; }

 private:
  std::shared_ptr<const Procedure> of_earlier_run(const record::PassRow& pass);

  const protocols::BoneDefinition& d_;
  fs::path resumed_;
  LiveDrilling live_;
  std::string trouble_;  // of the session's thread
};

/// Procedure of the file on the bone that the first pass after --resume goes on with.
std::shared_ptr<const Procedure> DrillingFigures::of_earlier_run(const record::PassRow& pass) {
  const fs::path resumed = std::exchange(resumed_, {});
  if (resumed.empty() || pass.practice || pass.attempt < 2) {
    return nullptr;
  }
  try {
    const record::SessionReader file(resumed);
    const auto passes = file.passes();
    const bool same_bone = std::any_of(passes.begin(), passes.end(), [&](const auto& row) {
      return row.trial == pass.trial && !row.practice && row.repetition == pass.repetition;
    });
    for (auto& procedure : load_procedures(file, procedure_setup(d_))) {
      if (same_bone && procedure.number == pass.trial) {
        return std::make_shared<const Procedure>(std::move(procedure));
      }
    }
  } catch (const std::exception& error) {  // nothing that a session should end for
    trouble_ = fmt::format("live figures leave out the passes before the session was resumed: {}",
                           sentence_of(error));
  }
  return nullptr;
}

class BoneStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::bone_drilling(); }
  void read_analysis(Table& root, const protocols::Definition* definition, bool) const override {
    const auto* d = dynamic_cast<const protocols::BoneDefinition*>(definition);
    read_drilling_learning(root, d);
    check_curriculum(root, d);
  }
  void check_loaded(const protocols::Definition& definition) const override {
    check_criteria(dynamic_cast<const protocols::BoneDefinition&>(definition));
  }
  std::optional<NextCase> next_case(const protocols::Definition& definition, const fs::path& folder,
                                    const std::vector<fs::path>& sessions) const override {
    const auto& d = dynamic_cast<const protocols::BoneDefinition&>(definition);
    return d.curriculum ? std::optional(next_case_of(d, folder, sessions)) : std::nullopt;
  }
  std::unique_ptr<record::LiveFigures> live_figures(const protocols::Definition& definition,
                                                    const fs::path& resumed) const override {
    return std::make_unique<DrillingFigures>(
        dynamic_cast<const protocols::BoneDefinition&>(definition), resumed);
  }
  std::vector<std::string> after_session(const protocols::Definition& definition,
                                         const fs::path& folder,
                                         const fs::path& file) const override {
    return page_after_session(dynamic_cast<const protocols::BoneDefinition&>(definition), folder,
                              file);
  }
  void add_preview(const protocols::Definition& definition, const PreviewRequest& request,
                   Preview& preview) const override {
    add_drilling_preview(dynamic_cast<const protocols::BoneDefinition&>(definition), request,
                         preview);
  }
  std::shared_ptr<TriedTrial> tried_trial(const protocols::Definition& definition,
                                          const PreviewRequest& request) const override {
    return tried_drilling(dynamic_cast<const protocols::BoneDefinition&>(definition), request);
  }
  void add_methods(const protocols::Definition& definition, std::uint64_t seed,
                   analysis::Document& document) const override {
    add_drilling_methods(dynamic_cast<const protocols::BoneDefinition&>(definition), seed,
                         document);
  }
  std::vector<std::string> analyze(const AnalysisRequest& request) const override {
    return analyze_drillings(request);
  }
  std::string next_step(const fs::path& folder) const override {
    return "haptrial replay " + session_files(folder).front().string();
  }
};

}  // namespace

const Study& bone_study() {
  static const BoneStudy study;
  return study;
}

}  // namespace haptrial::experiments
