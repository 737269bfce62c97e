#pragma once

#include <vector>

#include "protocols/trials/definition/trials_definition.h"
#include "protocols/trials/stages/read_stages.h"

namespace haptrial {
class Table;
}  // namespace haptrial

namespace haptrial::protocols {

// What the tables of a definition ask of each other. Problems are noted.

/// What procedures set and what they learn from.
void check_procedures(Table& root, const TrialsDefinition& definition);

/// A stage names fields, regions, looks and objects: each name stands for one thing.
void check_object_names(Table& root);

/// What stages show, and who names them.
/// @param stages  of the first trial
void check_stages(Table& root, const TrialsDefinition& definition,
                  const std::vector<NamedStage>& stages);

}  // namespace haptrial::protocols
