#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::analysis::trials {

/// An answer of one participant. Their trials stand in the order in which they were given.
struct SerialTrial {
  std::size_t session{0};
  std::size_t series{0};  // whose function it follows
  double level{0.0};      // [unit of the variable]
  int outcome{0};         // 1 or 0
  int choice{0};          // +1 or -1
  int side{1};            // the choice whose outcome is 1, likewise
};

/// The function of each series; none: its trials do not take part.
using SerialFunctions = std::vector<std::optional<psychometric::PsychometricFunction>>;

struct SerialCoefficients {
  Defined<double> drift{Undefined{"nothing was fitted"}};       // log odds, first to last trial
  Defined<double> repetition{Undefined{"nothing was fitted"}};  // log odds of the answer before
  double drift_error{0.0};  // standard errors of those that are defined, functions given
  double repetition_error{0.0};
};

/// Logistic regressions beside the functions psi, o = logit psi:
///
///     logit P(answer 1) = a + b o + drift t,                t from -1/2 to 1/2 over the trials
///     logit P(choice +) = a + b s o + repetition / 2 r      s the side, r the choice before
///
/// The bias of the second from the estimated intercept, -1 / (trials w) with w the mean of
/// psi (1 - psi), is added back (Kendall 1954, Biometrika 41, for a series' correlation with
/// itself). The answer before is that of the trial before in the session, whatever its series.
SerialCoefficients serial_coefficients(std::span<const SerialTrial> trials,
                                       const SerialFunctions& functions);

}  // namespace haptrial::analysis::trials
