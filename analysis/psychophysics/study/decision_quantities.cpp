#include "analysis/psychophysics/study/decision_quantities.h"

namespace haptrial::analysis::trials {
namespace {

template <class Condition>
std::vector<Quantity> quantities_of_ratings(const std::vector<Condition>& all,
                                            const TrialsPlan& plan) {
  std::vector<QuantityValue> meta, ratio;
  for (const Condition& one : all) {
    if (one.meta) {
      meta.push_back({one.participant, one.levels, one.meta->meta_d});
      ratio.push_back({one.participant, one.levels, one.meta->ratio});
    }
  }
  return {quantity("meta_d", "meta-d'", "", meta, plan),
          quantity("m_ratio", "M-ratio (meta-d' / d')", "", ratio, plan)};
}

}  // namespace

std::vector<Quantity> diffusion_quantities(const std::vector<TimedCondition>& all,
                                           const TrialsPlan& plan) {
  const TrialsPlan two_sided = without_directions(plan);
  const auto values = [&](DiffusionEstimate DiffusionFit::*parameter) {
    std::vector<QuantityValue> of;
    for (const TimedCondition& one : all) {
      if (one.diffusion) {
        of.push_back({one.participant, one.levels, ((*one.diffusion).*parameter).value});
      }
    }
    return of;
  };
  return {quantity("drift", "drift rate", "", values(&DiffusionFit::drift), two_sided),
          quantity("boundary", "boundary separation", "", values(&DiffusionFit::boundary),
                   two_sided, ValueRange::kPositive),
          quantity("non_decision_time", "non-decision time", "s",
                   values(&DiffusionFit::non_decision), two_sided, ValueRange::kPositive)};
}

std::vector<Quantity> metacognition_quantities(const std::vector<DetectedCondition>& all,
                                               const TrialsPlan& plan) {
  return quantities_of_ratings(all, plan);
}

std::vector<Quantity> metacognition_quantities(const std::vector<IdentifiedCondition>& all,
                                               const TrialsPlan& plan) {
  return quantities_of_ratings(all, plan);
}

}  // namespace haptrial::analysis::trials
