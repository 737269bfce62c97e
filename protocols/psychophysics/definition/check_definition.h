#pragma once

#include <vector>

#include "core/base/definition/schema_forward.h"
#include "protocols/psychophysics/definition/read_stages.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {

// Checks between the tables of a definition. Problems are noted.

/// Checks the values that procedures set, and the answers that they learn from.
void check_procedures(Table& root, const TrialsDefinition& definition);

/// Checks that the screen and the workspace have room for lines on which marks move.
void check_marks(Table& root, const TrialsDefinition& definition);

/// A stage names fields, regions, looks and objects: each name stands for one thing.
void check_object_names(Table& root);

/// Checks the contents that stages show, and the names that refer to them.
/// @param stages  of the first trial
void check_stages(Table& root, const TrialsDefinition& definition,
                  const std::vector<NamedStage>& stages);

}  // namespace haptrial::protocols
