#pragma once

#include <string_view>

#include "core/base/definition/definition_changes.h"
#include "core/record/rows/session_types.h"

namespace haptrial::protocols {

class Protocol;

/// The hand that held the tool. If it was a person's, the tables of the virtual hand were not used.
enum class Hand { kPerson, kVirtual };

/// Differences that the definitions of one study's sessions may have (docs/guide-experimenter.md).
DefinitionRules study_rules(const Protocol& protocol, Hand hand);

/// Differences between two sessions' definitions: whether they are of one study.
DefinitionChanges study_changes(const Protocol& protocol, const record::SessionInfo& before,
                                const record::SessionInfo& after);
/// The same of a session that is about to be recorded. @param device  its name; the virtual one has
/// a virtual hand
DefinitionChanges study_changes(const Protocol& protocol, const record::SessionInfo& before,
                                std::string_view definition, std::string_view device);

}  // namespace haptrial::protocols
