#pragma once

#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/psychometric/definition/track.h"

namespace haptrial::psychometric {

/// Reads [procedure], or several [[procedures]]; without either there are no tracks. Its
/// [[procedure.tracks]], if there are any, are tracks of their own: each key is taken from the
/// track or else from the procedure. Keys in brackets are optional.
///
///     kind       word of a kind of procedure, which has keys of its own (procedure_kinds.h)
///     variable   that it sets; [unit]
///     [name]     of a track; "track 1", … if left out
///     [by]       factors
///     [counts]   formula of the outcome that it learns from (OutcomeForm)
///     [resolution], [expect] (expectation.h)
std::vector<Track> read_tracks(Table& root);

}  // namespace haptrial::psychometric
