#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/tests/t_tests.h"
#include "analysis/trials/psychometric/function_fit.h"

namespace haptrial::analysis::trials {

/// What the trials of a participant say beside the level: change over the session, and dependence
/// on the answer before.
struct SerialEffects {
  std::string participant;
  std::size_t trials{0};
  Defined<double> drift{Undefined{"nothing was fitted"}};       // log odds, first to last trial
  Defined<double> repetition{Undefined{"nothing was fitted"}};  // log odds of the answer before
  std::size_t easy{0};                                          // trials at levels where S > 0.99
  std::size_t easy_wrong{0};                                    // of them with answer 0
  std::size_t limited{0};  // trials whose level is not the one that was asked for
};

/// Logistic regressions beside the fitted functions psi of the participant's series, o = logit psi:
///
///     logit P(answer 1) = a + b o + drift t,                t from -1/2 to 1/2 over the trials
///     logit P(choice +) = a + b s o + repetition / 2 r      s, r = +-1
///
/// s is the side of the choice whose outcome is 1, r the choice before. Without two choices the
/// outcome counts as the choice, and s = 1. The bias of
/// the second from the estimated intercept, -1 / (trials w) with w the mean of psi (1 - psi), is
/// added back (Kendall 1954, Biometrika 41, for a series' correlation with itself). Practice and
/// trials without a function do not take part; the answer before is that of the trial before in the
/// session, whatever its condition.
std::vector<SerialEffects> serial_effects(const TrialsData& data,
                                          const std::vector<AnsweredSeries>& series,
                                          const std::vector<FunctionFit>& fits,
                                          const TrialsPlan& plan);

/// The mean over participants against 0. Undefined as paired_t_test.
Defined<TTest> against_zero(const std::vector<double>& values);

/// Values of those participants who have them.
std::vector<double> drifts(const std::vector<SerialEffects>& effects);
std::vector<double> repetitions(const std::vector<SerialEffects>& effects);

}  // namespace haptrial::analysis::trials
