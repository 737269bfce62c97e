#pragma once

#include "protocols/interface/drawing.h"
#include "protocols/trials/definition/trials_definition.h"

namespace haptrial::protocols {

/// What the participant sees of trials: marks and the hand, the number of the interval, questions
/// with their choices, whether an answer was right. @param definition  outlives the drawing
MakeDrawing trial_drawing(const TrialsDefinition& definition);

}  // namespace haptrial::protocols
