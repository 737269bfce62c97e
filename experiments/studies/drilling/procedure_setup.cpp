#include "experiments/studies/drilling/procedure_setup.h"

#include "core/record/read/session_reader.h"

namespace haptrial::experiments {

namespace drilling = analysis::drilling;

drilling::ProcedureSetup procedure_setup(const record::SessionReader& session,
                                         const std::vector<protocols::StudyGroup>& groups) {
  const record::SessionInfo& info = session.info();
  drilling::ProcedureSetup setup =
      procedure_setup(protocols::parse_bone_definition(info.definition, info.definition_name));
  setup.group = protocols::group_of(groups, info.subject);
  return setup;
}

drilling::ProcedureSetup procedure_setup(const protocols::BoneDefinition& definition) {
  drilling::ProcedureSetup setup;
  setup.scale = definition.drilling.scale;
  setup.handle = definition.drilling.handle;
  setup.pose_WB = [placement = definition.placement](const geometry::VoxelGrid& grid) {
    return pose_of(placement, grid);
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
