#include "analysis/psychometric/hierarchical/predictive_check.h"

#include <algorithm>
#include <cmath>

namespace haptrial::analysis::hierarchical {
namespace {

double part_of(double count, double share, double probability) {
  return count > 0.0 ? 2.0 * count * std::log(share / probability) : 0.0;
}

/// Part of a block in the deviance of answers from a function.
double deviance(int ones, int total, double p) {
  const double n = total, one = ones;
  return part_of(one, one / n, std::max(p, 1e-300)) +
         part_of(n - one, 1.0 - one / n, std::max(1.0 - p, 1e-300));
}

int draw_ones(int total, double p, RandomStream& random) {
  int ones = 0;
  for (int i = 0; i < total; ++i) {
    ones += random.uniform() < p ? 1 : 0;
  }
  return ones;
}

/// Draws of one number of each person or series.
using Numbers = std::vector<std::vector<double>>;

Numbers family_draws(const Model& model, const Sampler& sampler, FamilyIndex family) {
  const NumberPlaces places(model);
  Numbers all;
  for (std::size_t e = 0; e < model.family(family).entries(); ++e) {
    all.push_back(sampler.draws(places.families[family].values + e));
  }
  return all;
}

}  // namespace

std::vector<double> predictive_p(const Model& model, const Sampler& sampler, std::size_t most,
                                 std::uint64_t seed) {
  const Numbers thresholds = family_draws(model, sampler, kThresholds);
  const Numbers widths = family_draws(model, sampler, kLogWidths);
  const Numbers lapses = family_draws(model, sampler, kLapses);
  const Numbers guesses = family_draws(model, sampler, kGuesses);
  const std::size_t all = thresholds.front().size(), step = std::max<std::size_t>(all / most, 1);
  RandomStream random(seed, "hierarchical predictive");
  const Family& family = model.family(kThresholds);
  std::vector<double> shares;
  for (std::size_t person = 0; person < model.people(); ++person) {
    double at_least = 0.0, count = 0.0;
    for (std::size_t draw = 0; draw < all; draw += step) {
      const Model::Rates rates = model.rates(lapses.empty() ? 0.0 : lapses[person][draw],
                                             guesses.empty() ? 0.0 : guesses[person][draw]);
      double given = 0.0, replicated = 0.0;
      for (std::size_t s = family.first[person]; s < family.first[person + 1]; ++s) {
        const std::vector<double> p =
            model.probabilities(s, thresholds[s][draw], widths[s][draw], rates);
        const std::vector<TrialBlock>& blocks = model.answers()[s].blocks;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
          given += deviance(blocks[i].correct, blocks[i].total, p[i]);
          replicated += deviance(draw_ones(blocks[i].total, p[i], random), blocks[i].total, p[i]);
        }
      }
      at_least += replicated >= given ? 1.0 : 0.0;
      count += 1.0;
    }
    shares.push_back(at_least / count);
  }
  return shares;
}

}  // namespace haptrial::analysis::hierarchical
