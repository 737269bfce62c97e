#include "experiments/studies/psychophysics/reach_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/definition/trial_values.h"

namespace haptrial::experiments {
namespace {

using analysis::trials::GivenVariable;
using analysis::trials::ReachingPlan;
using analysis::trials::ReachRoute;
using analysis::trials::StudyTrial;
using analysis::trials::TrialsData;

constexpr double kNearTarget = 1e-9;  // a region whose centre is so near is the target's [m]

/// The definition, read anew for every trial: places may depend on all that a trial is.
class ReachRoutes {
 public:
  ReachRoutes(const protocols::TrialsDefinition& definition, const ReachingPlan& plan)
      : definition_(definition),
        plan_(plan),
        root_(definition.root()),
        names_(protocols::read_names(root_, definition)) {}

  ReachRoute of(const TrialsData& data, const StudyTrial& trial) {
    const std::string group =
        definition_.groups.empty()
            ? std::string()
            : protocols::group_of(definition_.groups, data.session_of(trial).participant);
    give(trial, data.session_of(trial).session, group);
    return read(trial);
  }

 private:
  void give(const StudyTrial& trial, int session, const std::string& group) {
    names_->forget_given();
    names_->set("trial", trial.trial);
    names_->set("session", session);
    names_->set("group", group);
    names_->set("probe", trial.probe.empty() ? std::string("no") : trial.probe.text());
    const auto stage = std::find_if(trial.stages.rbegin(), trial.stages.rend(),
                                    [&](const auto& each) { return each.stage == plan_.stage; });
    const int interval = stage == trial.stages.rend() ? 1 : stage->interval;
    names_->set("interval", interval);
    for (const int of : {0, interval}) {
      for (const GivenVariable& variable : trial.variables) {
        if (variable.interval != of) {
          continue;
        }
        variable.word.empty() ? names_->set(variable.name, variable.value)
                              : names_->set(variable.name, variable.word);
      }
    }
  }

  ReachRoute read(const StudyTrial& trial) {
    const protocols::Presented presented =
        protocols::read_presented(root_, *names_, definition_, nullptr);
    root_.check();
    ReachRoute way;
    way.start = names_->place(plan_.start);
    way.target = names_->place(plan_.target);
    if (way.start.x() == way.target.x() && way.start.z() == way.target.z()) {
      throw InputError(
          fmt::format("{}: the places {} and {} lie above each other in trial {}; a reach needs a "
                      "way between them",
                      definition_.file_name, plan_.start, plan_.target, trial.trial));
    }
    for (const scene::Region& region : presented.regions) {
      const auto* sphere = std::get_if<scene::Sphere>(&region.shape);
      if (sphere != nullptr && (sphere->centre - way.target).norm() < kNearTarget) {
        way.target_radius = sphere->radius;
      }
    }
    const auto stage = std::find_if(presented.stages.begin(), presented.stages.end(),
                                    [&](const auto& each) { return each.name == plan_.stage; });
    for (std::size_t i = 0; i < presented.fields.size(); ++i) {
      const bool acts = stage != presented.stages.end() && (stage->stage.fields >> i & 1U) != 0;
      add_field(presented.fields[i], acts, way);
    }
    return way;
  }

  void add_field(const scene::Field& field, bool acts, ReachRoute& way) const {
    if (field.name == plan_.field) {
      if (const auto* matrix = std::get_if<scene::MatrixViscousParameters>(&field.kind)) {
        way.field = matrix->matrix;
        way.active = acts;
      }
    }
    const bool channel = std::holds_alternative<scene::LineChannelParameters>(field.kind) ||
                         std::holds_alternative<scene::AxisChannelParameters>(field.kind);
    way.clamp = way.clamp || (acts && channel);
  }

  const protocols::TrialsDefinition& definition_;
  const ReachingPlan& plan_;
  Table root_;
  std::unique_ptr<protocols::Names> names_;
};

}  // namespace

std::vector<std::optional<ReachRoute>> reach_routes(const protocols::TrialsDefinition& definition,
                                                    const TrialsData& data,
                                                    const ReachingPlan& plan) {
  ReachRoutes routes(definition, plan);
  std::vector<std::optional<ReachRoute>> all;
  for (const StudyTrial& trial : data.trials) {
    all.push_back(trial.counts() ? std::optional(routes.of(data, trial)) : std::nullopt);
  }
  return all;
}

analysis::trials::ReachingNames reaching_names(const protocols::TrialsDefinition& definition) {
  analysis::trials::ReachingNames names;
  names.stages = definition.stages;
  names.combinations = 1;
  for (const protocols::Factor& factor : definition.order.factors) {
    names.combinations *= factor.levels.size();
  }
  Table root = definition.root();
  if (root.has("places")) {
    names.places = root.table("places").keys_as_written();
  }
  if (root.has("fields")) {
    Table fields = root.table("fields");
    for (const std::string& name : fields.keys_as_written()) {
      if (fields.table(name).whole_text("type") == "matrix_viscous") {
        names.fields.push_back(name);
      }
    }
  }
  return names;
}

}  // namespace haptrial::experiments
