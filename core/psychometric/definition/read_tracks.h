#pragma once

#include <vector>

#include "core/psychometric/definition/track.h"

namespace haptrial {
class Table;
}

namespace haptrial::psychometric {

/// Reads [procedure], or several [[procedures]]; without either there are no tracks. Its
/// [[procedure.tracks]], if there are any, are tracks of their own: each key is taken from the
/// track or else from the procedure. Keys in brackets are optional.
///
///     kind       "staircase", "pest", "psi", "quest_plus" (read_quest.h), "constant",
///                "adjustment" or "magnitude"
///     variable   that it sets; [unit]
///     [name]     of a track; "track 1", … if left out
///     [by]       factors
///     [counts]   formula of the outcome: of a staircase, PEST, psi or constant stimuli 1 or 0, of
///                magnitudes a number above 0
///     [resolution], [expect] (expectation.h)
///     range      [lowest, highest]; of listed levels theirs
///     [scale]    of steps and functions: "linear", "log10" or "decibel"; [origin]
///
///     staircase  start, steps or [[step down, step up], …], [down], [up], [schedule], stop =
///                { reversals, trials }, [estimate] = { of, skip, last }, [at_bound],
///                [right_raises], [first_down], [first_up]
///     pest       start, [target], [deviation], first_step, smallest_step, largest_step, stop
///     psi        levels, [function], [threshold], [width], [guess], [lapse], stop = { trials,
///                entropy }, [marginal]
///     constant   levels, repetitions, [in_rounds]
///     magnitude  levels, repetitions, [in_rounds], [modulus]
///
/// Grids of psi (levels, threshold, width, lapse) are lists or { from, to, count, [spacing] }.
std::vector<Track> read_tracks(Table& root);

}  // namespace haptrial::psychometric
