#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/subject/perceiver/judgement.h"
#include "core/subject/perceiver/perceiver_population.h"
#include "core/subject/perceiver/sight.h"
#include "core/subject/perceiver/two_rate.h"
#include "protocols/psychophysics/definition/script_plan.h"
#include "protocols/psychophysics/subject/stage_actions.h"

namespace haptrial::protocols {

struct TrialQuestion;

/// How virtual participants of trials take what they feel for an answer.
enum class Decides : std::uint8_t { kLargest, kSmallest, kYes, kNearest, kMagnitude, kAdjust };

/// Motor adaptation to a field B v, or to the rotation of the cursor.
struct Adaptation {
  std::optional<Eigen::Matrix3d> field;  // B [N·s/m]; nothing: to the cursor
  subject::TwoRateParameters rates;
  std::string stage;  // of the reach that is learnt from
};

/// The virtual participants of a dry run.
struct ObserverPlan {
  subject::Quantity senses{subject::Quantity::kForce};
  std::string stage;      // in which it is felt; empty: throughout the interval
  std::size_t device{0};  // whose hand feels it
  Decides decides{Decides::kLargest};
  int yes{0};                       // choice that means yes, from 0
  std::vector<double> prototypes;   // (choices) percepts that the choices stand for, of kNearest
  int raise{0}, lower{1}, done{2};  // choices of an adjustment, from 0
  double wanted{1.0};    // percept that is adjusted to, if the trial shows none before [its unit]
  double reaction{0.6};  // median time from question to answer > 0 [s]
  std::vector<StageAction> actions;
  std::optional<Adaptation> adaptation;
  std::optional<subject::SightParameters> sight;
  std::optional<subject::PerceiverPopulation> people;
  std::optional<ScriptPlan> script;  // by which they answer, in place of `decides`
};

/// Reads [observer]; without it participants answer at random and rest. Problems are noted.
ObserverPlan read_observer(Table& root, const std::vector<TrialQuestion>& questions,
                           const std::vector<std::string>& stages,
                           const std::vector<TrialDevice>& devices = {});

}  // namespace haptrial::protocols
