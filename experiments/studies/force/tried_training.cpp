#include "experiments/studies/force/tried_training.h"

#include <fmt/format.h>

#include <utility>

#include "experiments/preview/tried_pass.h"
#include "protocols/force_training/guided_passes.h"
#include "protocols/force_training/recorded_pass.h"

namespace haptrial::experiments {
namespace {

using protocols::ForceDefinition;
using protocols::GuidedPass;
using protocols::GuidedTrial;
using record::Phase;

class TriedTraining final : public TriedPass {
 public:
  TriedTraining(const ForceDefinition& d, GuidedTrial trial)
      : TriedPass(d, trial.stimulus.path.points().front()), d_(d), trial_(std::move(trial)) {
    choose(0);
  }

  std::vector<std::string> stages() const override {
    std::vector<std::string> names;
    for (const GuidedPass& pass : trial_.passes) {
      names.emplace_back(pass.phase.name());
    }
    return names;
  }
  std::vector<SpaceObject> objects() const override {
    return {{"path", 0, lines_of(trial_.stimulus.path.points())}};
  }
  void choose(std::size_t stage) override {
    phase_ = trial_.passes[stage].phase;
    begin(
        make_pass(trial_.plan.condition, phase_, trial_.stimulus, d_.guidance, trial_.plan.block));
  }
  std::string now() const override {
    if (is_over()) {
      return fmt::format("{}: over", phase_.name());
    }
    return fmt::format("{}: {}, target force {:.2f} N", phase_.name(), name_of(output().stage),
                       output().target_force);
  }

 private:
  void before_tick() override {
    if (is_over() && phase_ == Phase::kTraining) {
      choose(1);
    }
  }

  const ForceDefinition& d_;
  GuidedTrial trial_;
  Phase phase_{Phase::kTraining};
};

}  // namespace

std::shared_ptr<TriedTrial> tried_training(const ForceDefinition& definition,
                                           const PreviewRequest& request) {
  return std::make_shared<TriedTraining>(
      definition,
      protocols::guided_trial(definition, previewed_session(request.seed), request.trial));
}

}  // namespace haptrial::experiments
