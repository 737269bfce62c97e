#pragma once

#include <cstddef>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::test {

/// How many periods are neither a picture nor counted as missed. A picture that is late itself is
/// counted with the next: of many first and last pictures, those two count that were late alike.
/// @param frames  at least 40, whose first ten may take longer
double unaccounted_periods(const std::vector<record::FrameRow>& frames, double rate);

}  // namespace haptrial::test
