#pragma once

#include <memory>

#include "protocols/interface/drawing.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/objects/seen_bodies.h"

namespace haptrial::protocols {

/// Drawing of trials for the participant: marks and the hand, the number of the interval, questions
/// with their choices, whether an answer was right. @param definition  outlives the drawing
/// @param bodies  that give way; null: all are seen at rest
MakeDrawing trial_drawing(const TrialsDefinition& definition,
                          std::shared_ptr<const SeenBodies> bodies = {});

}  // namespace haptrial::protocols
