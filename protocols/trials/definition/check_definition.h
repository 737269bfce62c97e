#pragma once

#include <span>

#include "core/base/definition/table.h"
#include "protocols/trials/definition/trials_definition.h"
#include "protocols/trials/stages/read_stages.h"

namespace haptrial::protocols {

// Mistakes that no single key shows. Each is a sentence of the table where it stands.

/// A stage names fields, regions, looks and objects: each name stands for one thing.
void check_object_names(Table& root);

/// Tracks of procedures: names, what sets their variables, what they learn from.
void check_procedures(Table& root, const TrialsDefinition& d);

/// What names stages, or is named by them: objects that are seen, reactions, masking noise.
void check_stages(Table& root, const TrialsDefinition& d, std::span<const NamedStage> stages);

}  // namespace haptrial::protocols
