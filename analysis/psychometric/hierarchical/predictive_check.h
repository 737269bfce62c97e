#pragma once

#include <cstdint>
#include <vector>

#include "analysis/psychometric/hierarchical/sampler.h"

namespace haptrial::analysis::hierarchical {

/// For each person the share of draws from the posterior for which answers that are drawn from the
/// function deviate from it at least as much as those that were given: low if answers scatter more
/// than the function explains. Levels are those that were presented.
/// @param most  how many draws are taken, evenly over all chains
/// Source: Gelman, Meng and Stern 1996, Statistica Sinica 6, 733.
std::vector<double> predictive_p(const Model& model, const Sampler& sampler, std::size_t most,
                                 std::uint64_t seed);

}  // namespace haptrial::analysis::hierarchical
