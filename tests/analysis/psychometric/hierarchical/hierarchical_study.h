#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/psychometric/hierarchical/family_state.h"
#include "analysis/psychometric/hierarchical/hierarchical_fit.h"

namespace haptrial::test {

/// Studies of forced choice at listed levels.
struct HierarchicalStudy {
  std::size_t people{6}, conditions{2}, levels{6};
  int trials{8};  // at each level
  analysis::LikelihoodOptions options;
};

/// A study with a cumulative Gaussian and a guess rate of 1/2. The levels lie from 0 to 1, so that
/// the units of a model are those of the axis, apart from its middle.
HierarchicalStudy small_study();

/// The design with no answers 1, to draw parameters from the priors of its model.
analysis::hierarchical::Model model_without_answers(const HierarchicalStudy& study);
/// Answers of people with the given parameters.
analysis::hierarchical::Model simulated_model(const HierarchicalStudy& study,
                                              const analysis::hierarchical::State& truth,
                                              RandomStream& random);

/// People as `mean` and spreads of each family say: thresholds 0 and `effect` from the middle.
analysis::hierarchical::State typical_people(const HierarchicalStudy& study, double effect,
                                             RandomStream& random);

/// Ranks of numbers that were drawn from the prior among draws from the posterior of answers to
/// them: uniform if the sampler is right (Talts, Betancourt, Simpson, Vehtari and Gelman 2018).
struct Calibration {
  std::vector<std::string> names;
  std::vector<std::vector<std::size_t>> ranks;  // (names, studies) 0 .. kRanks - 1
};
inline constexpr std::size_t kRanks = 100;
Calibration calibration(const HierarchicalStudy& study, std::size_t studies, std::uint64_t seed,
                        int threads);
/// p of the chi-square of ranks in equal bins. @param bins  divides kRanks
double uniform_p(const std::vector<std::size_t>& ranks, std::size_t bins);

/// How many intervals of 95 % hold the true number.
struct Coverage {
  std::vector<std::string> names;
  std::vector<std::size_t> held;
};
Coverage coverage(const HierarchicalStudy& study, std::size_t studies, std::uint64_t seed,
                  int threads);

}  // namespace haptrial::test
