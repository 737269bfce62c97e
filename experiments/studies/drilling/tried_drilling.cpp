#include "experiments/studies/drilling/tried_drilling.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/bone/simulator/companions.h"
#include "experiments/preview/tried_pass.h"
#include "experiments/studies/drilling/drilling_objects.h"
#include "experiments/studies/drilling/drilling_preview.h"
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

}  // namespace

std::shared_ptr<TriedTrial> tried_drilling(const BoneDefinition& definition,
                                           const PreviewRequest& request) {
  const protocols::PlannedTrial trial = procedure_of(definition, request);
  return std::make_shared<TriedDrilling>(definition, bone_of(definition, trial), trial);
}

}  // namespace haptrial::experiments
