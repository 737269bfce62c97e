#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/subject/perceiver/judgement.h"
#include "core/subject/perceiver/perceiver_population.h"
#include "core/subject/perceiver/probing.h"
#include "core/subject/perceiver/sight.h"
#include "core/subject/perceiver/two_rate.h"
#include "protocols/psychophysics/definition/script_plan.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

struct Question;
struct TrialDevice;

/// How virtual participants of trials take what they feel for an answer.
enum class Decides : std::uint8_t { kLargest, kSmallest, kYes, kNearest, kMagnitude, kAdjust };

/// Action of a hand in a stage.
struct StageAction {
  std::string stage;
  std::size_t device{0};  // whose hand
  subject::Probe probe;
  bool to_mark{false};  // a reach to the first mark for this device that is shown
};

/// Motor adaptation to a field B v.
struct Adaptation {
  Eigen::Matrix3d field{Eigen::Matrix3d::Zero()};  // B [N·s/m]
  subject::TwoRateParameters rates;
  std::string stage;  // of the reach that is learnt from
};

/// The virtual participants of a dry run.
struct ObserverPlan {
  subject::Quantity senses{subject::Quantity::kForce};
  std::string stage;  // in which it is felt; empty: throughout the interval
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

/// Reads [observer]; without it participants answer at random and rest. Keys in brackets are
/// optional.
///
///     [senses]      "force", "stiffness", "compliance", "viscosity", "friction", "roughness",
///                   "extent", "unevenness", "contrast"
///     [in_stage]    in which it is felt
///     [decides]     "largest", "smallest", "yes", "nearest": the choice whose prototype is nearest
///                   to what was felt; "magnitude" or "adjust": the last interval until it feels as
///                   the first one, or as `wanted`
///     [prototypes]  of "nearest": a percept for each choice of the first question
///     [raise], [lower], [done]  values of the choices of an adjustment; the first three in this
///                   order if left out. [wanted] a percept
///     [yes]         value of the choice that means yes; the first one if left out
///     [reaction]    [s]
///     [actions]     stage = { do = "press", force, [rise], [direction], [travel] },
///                   { do = "stroke", direction, half_length, frequency, [force], [normal] },
///                   { do = "follow", [towards], [around], [then_around], [turn_after], [speed],
///                   [force] }: round an object (core/subject/perceiver/contour.h),
///                   { do = "palpate", at, force, [direction], [move], [press] }: presses at places
///                   one after the other (core/subject/perceiver/palpation.h),
///                   { do = "reach", duration }: to the first mark that the stage shows,
///                   { do = "hold" } or { do = "rest" }, as in stages without one;
///                   with [devices] stage = { NAME = { do = … }, … }, or the same for all of them
///     [sight]       { noise, sd [m], [spread] } of a size that is seen (core/subject/perceiver)
///     [adaptation]  { stage, matrix, [fast], [slow] }
///     [script]      { file, [deadline] }: answers (script_plan.h)
///     and the keys of the person (perceiver_population.h)
ObserverPlan read_observer(Table& root, const std::vector<Question>& questions,
                           const std::vector<std::string>& stages,
                           const std::vector<TrialDevice>& devices = {});

}  // namespace haptrial::protocols
