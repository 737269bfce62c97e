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
  setup.pose_WB = [placement = definition.placement](const geometry::VoxelGrid& grid) {
    return pose_of(placement, grid);
  };
  for (const bone::ToolSpec& tool : definition.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    setup.tools.push_back({tool.name, burr != nullptr ? burr->radius() : 0.0});
  }
  return setup;
}

}  // namespace haptrial::experiments
