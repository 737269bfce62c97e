#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/function/psychometric_function.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

/// A further dimension of a level.
struct TrackDimension {
  std::string variable;  // that it sets
  double low{0.0}, high{0.0};
  double resolution{0.0};  // 0: not rounded
};

/// One track of a procedure: it sets a variable of the definition, trial by trial, and learns from
/// what came of it.
struct Track {
  std::string name;
  std::string kind;             // "staircase", "pest", "psi", "quest_plus", "constant",
                                // "adjustment", "magnitude"
  std::string variable;         // that it sets
  std::string unit;             // of the variable, as a text
  std::vector<std::string> by;  // factors: each combination has a track of its own
  std::string counts;  // formula of what it learns; empty: whether the first answer was right
  double low{0.0}, high{0.0};           // the level is kept between them [unit]
  bool range_known{true};               // else a mistake in the range is noted
  double resolution{0.0};               // the level is rounded to a multiple of it; 0: not [unit]
  std::vector<TrackDimension> further;  // of a level with several dimensions
  int most_trials{0};                   // of one track
  bool listed{false};                   // its trials are known from the beginning
  std::size_t outcomes{2};              // that a track of answers tells apart
  std::optional<bool> falls;  // whether answers 1 get rarer as the level rises; none: not known
  Axis axis;                  // of its steps
  std::optional<StaircaseParameters> staircase;    // of a staircase
  std::optional<PsychometricParameters> expected;  // that the study counts on
  std::function<std::unique_ptr<Procedure>(std::uint64_t seed, const std::string& name)> begin;

  /// Names the outcomes that it can learn: "a number above 0", or "0 or 1".
  std::string lesson() const;
  /// Whether an outcome is one of these.
  bool learns(double outcome) const noexcept;
  /// Level that is presented if a level is asked for: rounded, within the range.
  double applied(double asked) const noexcept;
  Level applied(const Level& asked) const;
  /// Variables that the track sets, in the order of a level's dimensions.
  std::vector<std::string> variables() const;
  bool sets(const std::string& one) const;
  /// The lowest level of each dimension, or the highest.
  Level corner(bool high) const;
};

}  // namespace haptrial::psychometric
