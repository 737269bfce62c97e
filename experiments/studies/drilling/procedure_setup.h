#pragma once

#include "analysis/bone_drilling/metrics/procedure.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

/// Facts of a definition for metrics; the group is empty.
analysis::drilling::ProcedureSetup procedure_setup(const protocols::BoneDefinition& definition);
/// The same from the definition in a session file.
analysis::drilling::ProcedureSetup procedure_setup(const record::SessionReader& session);

}  // namespace haptrial::experiments
