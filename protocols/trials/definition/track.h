#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// One track of a procedure: it sets a variable of the definition, trial by trial, and learns from
/// what came of it.
struct Track {
  std::string name;
  std::string kind;             // "staircase", "pest", "psi", "constant", "magnitude"
  std::string variable;         // that it sets
  std::string unit;             // of the variable, as a text
  std::vector<std::string> by;  // factors: each combination has a track of its own
  std::string counts;  // formula of what it learns; empty: whether the first answer was right
  double low{0.0}, high{0.0};  // the level is kept between them [unit]
  double resolution{0.0};      // the level is rounded to a multiple of it; 0: not [unit]
  int most_trials{0};          // of one track
  bool listed{false};          // its trials are known from the beginning
  std::optional<psychometric::StaircaseParameters> staircase;  // of a staircase
  std::function<std::unique_ptr<psychometric::Procedure>(std::uint64_t seed,
                                                         const std::string& name)>
      begin;

  /// What is presented if a level is asked for.
  double applied(double asked) const noexcept;
};

/// Reads [procedure], or several [[procedures]]; without either there are no tracks. Its
/// [[procedure.tracks]], if there are any, are tracks of their own: each key is taken from the
/// track or else from the procedure. Keys in brackets are optional.
///
///     kind       "staircase", "pest", "psi", "constant" or "magnitude"
///     variable   that it sets; [unit]
///     [name]     of a track; "track 1", … if left out
///     [by]       factors
///     [counts]   formula of the outcome: of a staircase, PEST, psi or constant stimuli 1 or 0, of
///                magnitudes a number above 0
///     [resolution]
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

}  // namespace haptrial::protocols
