#pragma once

#include <string>

#include "protocols/interface/drawing.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {

struct TrialView;

/// A choice and before it the key that gives it.
std::string line_of(const TrialQuestion& question, std::size_t choice);

/// The text of a trial at one instant: the question with the answer so far, what is told of the
/// answer, or the interval's number. Empty: no text is shown.
PictureText text_of(const TrialsDefinition& definition, const TrialView& view);

}  // namespace haptrial::protocols
