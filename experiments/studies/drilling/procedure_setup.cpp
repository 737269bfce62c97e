#include "experiments/studies/drilling/procedure_setup.h"

#include <map>
#include <mutex>

#include "core/record/read/session_reader.h"
#include "core/subject/drilling/cavity_plan.h"

namespace haptrial::experiments {

namespace drilling = analysis::drilling;

namespace {

/// Plans of a session's bones, each made once. Any thread.
class KeptPlans {
 public:
  template <class Make>
  std::shared_ptr<const subject::CavityPlan> of(const std::shared_ptr<const bone::BoneModel>& bone,
                                                const Make& make) {
    const std::lock_guard lock(mutex_);
    auto& plan = plans_[bone];
    if (!plan) {
      plan = std::make_shared<const subject::CavityPlan>(make());
    }
    return plan;
  }

 private:
  std::mutex mutex_;
  std::map<std::shared_ptr<const bone::BoneModel>, std::shared_ptr<const subject::CavityPlan>>
      plans_;
};

}  // namespace

drilling::ProcedureSetup procedure_setup(const record::SessionReader& session) {
  const record::SessionInfo& info = session.info();
  const auto definition = protocols::parse_bone_definition(info.definition, info.definition_name);
  drilling::ProcedureSetup setup = procedure_setup(definition);
  setup.session_name = definition.session_plan(static_cast<int>(info.session)).name;
  setup.group = protocols::group_of(definition.groups, info.subject);
  return setup;
}

drilling::ProcedureSetup procedure_setup(const protocols::BoneDefinition& definition) {
  drilling::ProcedureSetup setup;
  setup.scale = definition.drilling.scale;
  setup.of_cases = definition.curriculum.has_value();
  setup.handle = definition.drilling.handle;
  setup.pose_WB = [placement = definition.placement](const geometry::VoxelGrid& grid) {
    return pose_of(placement, grid);
  };
  setup.plans = [kept = std::make_shared<KeptPlans>(), placement = definition.placement,
                 cavity = definition.cavity, fragment = definition.osteotomy,
                 burr = protocols::smallest_burr(definition)](
                    const std::shared_ptr<const bone::BoneModel>& bone) {
    drilling::ProcedurePlans plans{nullptr, fragment};
    if (cavity) {
      plans.cavity = kept->of(bone, [&] {
        return subject::plan_cavity(*bone, pose_of(placement, bone->grid), *cavity, burr);
      });
    }
    return plans;
  };
  for (const bone::ToolSpec& tool : definition.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    auto& made = setup.tools.emplace_back();
    made.name = tool.name;
    if (burr != nullptr) {
      made.burr_radius = burr->radius();
      made.shape = burr->burr.form == bone::BurrForm::kBall
                       ? nullptr
                       : std::make_shared<const bone::BurrShape>(burr->burr.dimensions());
    }
  }
  return setup;
}

}  // namespace haptrial::experiments
