#pragma once

#include "core/base/definition/schema.h"
#include "core/psychometric/procedure/shuffled.h"

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Order of levels, or starts, that stand in a list: [repetitions], [in_rounds].
const Schema<ListParameters>& list_schema();

/// Reads constant stimuli: levels, a grid, and their order. Problems are noted.
void read_constant(const TrackKeys& keys, Track& track);

/// Reads a magnitude estimation: levels, a grid, their order and [modulus]. Problems are noted.
void read_magnitude(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
