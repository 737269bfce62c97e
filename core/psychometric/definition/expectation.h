#pragma once

#include <optional>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::psychometric {

struct Track;

/// Reads `expect` of a procedure: the psychometric function that a study counts on, of the variable
/// that the track sets. Keys in brackets are optional.
///
///     expect = { threshold, width, [function], [guess], [lapse], [share] }
///
/// threshold is a level [unit of the variable], width on the axis of the track's steps. Problems
/// are noted.
std::optional<PsychometricParameters> read_expectation(Table& procedure, const Axis& axis);

/// Sentence about the result to expect of the track if people are as expected: estimate with bias
/// and standard deviation, and trials. It is exact if the track's predict() is, as that of a
/// staircase; others take 500 simulated tracks; listed levels give nothing, for there is no
/// estimate but a fit.
/// @returns nothing without an expectation, or if it cannot be said
std::optional<std::string> predicted(const Track& track);

}  // namespace haptrial::psychometric
