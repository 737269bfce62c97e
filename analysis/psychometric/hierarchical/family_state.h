#pragma once

#include <array>
#include <vector>

#include "analysis/psychometric/hierarchical/hierarchical_model.h"
#include "core/base/random.h"

namespace haptrial::analysis::hierarchical {

/// Values of a family at one place of a chain.
struct FamilyState {
  std::vector<double> values;  // (entries)
  std::vector<double> means;   // (columns)
  double between{1.0};         // spread of people, > 0
  double within{1.0};          // spread of a person over conditions, > 0; not used without `within`
};

using State = std::array<FamilyState, kFamilies>;

/// Log-density of a spread's prior at its value, by its logarithm, up to a constant.
double log_spread_prior(const FamilyPrior& prior, double spread) noexcept;

/// Inverse of the covariance of k entries of one person: diagonal - shared 1 1'.
struct EntryPrecision {
  double diagonal{1.0}, shared{0.0};
};
EntryPrecision entry_precision(const Family& family, const FamilyState& state,
                               std::size_t entries) noexcept;

/// Draws the means of a family given the values and the spreads, from their normal distribution.
void draw_means(const Family& family, FamilyState& state, RandomStream& random);

/// Draws each spread given the values and the means, by a slice over its logarithm.
/// Source: Neal 2003, Annals of Statistics 31(3), 705.
void draw_spreads(const Family& family, FamilyState& state, RandomStream& random);

}  // namespace haptrial::analysis::hierarchical
