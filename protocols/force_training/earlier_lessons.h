#pragma once

#include <vector>

#include "core/subject/virtual_subject.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// Lessons that a virtual participant had in earlier sessions of the blocks of this one; nothing in
/// a first session. The earlier sessions are taken as done as planned by a hand that made no error.
/// @param place  of the session
std::vector<subject::Lesson> earlier_lessons(const ForceDefinition& definition,
                                             const SessionPlace& place);

}  // namespace haptrial::protocols
