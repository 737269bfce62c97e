#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/definition_changes.h"
#include "core/record/rows/session_types.h"

namespace haptrial::protocols {

/// The tables of a definition that describe machines and not the study: devices and the screen. A
/// lab file may hold these and no others.
const std::vector<std::string>& machine_tables();

/// Whose hand held the tool. If it was a person's, the tables of the virtual hand were not used.
enum class Hand { kPerson, kVirtual };

/// What may differ between the definitions of one study's sessions (docs/guide-experimenter.md).
DefinitionRules study_rules(Hand hand);

/// What two sessions' definitions differ in: whether they are of one study.
DefinitionChanges study_changes(const record::SessionInfo& before,
                                const record::SessionInfo& after);
/// The same of a session that is about to be recorded. @param device  its name; the virtual one has
/// a virtual hand
DefinitionChanges study_changes(const record::SessionInfo& before, std::string_view definition,
                                std::string_view device);

}  // namespace haptrial::protocols
