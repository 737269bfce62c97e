#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "analysis/psychometric/models/diffusion.h"
#include "core/base/random.h"

namespace haptrial::test {

/// Choices of an observer who is a diffusion, from the distribution of the density on a grid.
inline std::vector<analysis::TimedChoice> simulated_choices(const analysis::Diffusion& model,
                                                            std::size_t trials,
                                                            RandomStream& random) {
  constexpr std::size_t kGrid = 8000;
  constexpr double kLongest = 8.0;  // [s]
  const double step = kLongest / static_cast<double>(kGrid);
  std::array<std::vector<double>, 2> sums;
  for (const bool upper : {false, true}) {
    std::vector<double>& sum = sums[upper ? 1 : 0];
    sum.push_back(0.0);
    for (std::size_t i = 1; i <= kGrid; ++i) {
      const double time = model.non_decision + (static_cast<double>(i) - 0.5) * step;
      sum.push_back(sum.back() + step * analysis::diffusion_density(model, upper, time));
    }
  }
  std::vector<analysis::TimedChoice> choices;
  for (std::size_t i = 0; i < trials; ++i) {
    const bool upper = random.uniform() < analysis::diffusion_share(model);
    const std::vector<double>& sum = sums[upper ? 1 : 0];
    const auto after = std::ranges::upper_bound(sum, random.uniform() * sum.back());
    const double cell = static_cast<double>(after - sum.begin()) - random.uniform();
    choices.push_back({upper, model.non_decision + cell * step});
  }
  return choices;
}

}  // namespace haptrial::test
