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

namespace haptrial::protocols {

/// One track of a procedure: it sets a variable of the definition, trial by trial, and learns from
/// what came of it.
struct Track {
  std::string name;
  std::string kind;             // "staircase", "pest", "psi", "constant", "adjustment",
                                // "magnitude"
  std::string variable;         // that it sets
  std::string unit;             // of the variable, as a text
  std::vector<std::string> by;  // factors: each combination has a track of its own
  std::string counts;  // formula of what it learns; empty: whether the first answer was right
  double low{0.0}, high{0.0};  // the level is kept between them [unit]
  double resolution{0.0};      // the level is rounded to a multiple of it; 0: not [unit]
  int most_trials{0};          // of one track
  bool listed{false};          // its trials are known from the beginning
  psychometric::Axis axis;     // of its steps
  std::optional<psychometric::StaircaseParameters> staircase;    // of a staircase
  std::optional<psychometric::PsychometricParameters> expected;  // that the study counts on
  std::function<std::unique_ptr<psychometric::Procedure>(std::uint64_t seed,
                                                         const std::string& name)>
      begin;

  /// What is presented if a level is asked for.
  double applied(double asked) const noexcept;
};

}  // namespace haptrial::protocols
