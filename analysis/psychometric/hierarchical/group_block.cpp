#include "analysis/psychometric/hierarchical/group_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::analysis::hierarchical {
namespace {

constexpr double kSmallestSpread = 1e-5;  // of the scale of its prior

}  // namespace

GroupBlock::GroupBlock(const Model& model) : model_(model) {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    for (std::size_t column = 0; column < family.columns; ++column) {
      places_.push_back({f, column, nullptr});
    }
    places_.push_back({f, 0, &FamilyState::between});
    if (family.within) {
      places_.push_back({f, 0, &FamilyState::within});
    }
  }
}

Eigen::VectorXd GroupBlock::values(const State& state) const {
  Eigen::VectorXd all(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    const FamilyState& own = state[place.family];
    all[i] = place.spread == nullptr ? own.means[place.column] : own.*place.spread;
  }
  return all;
}

void GroupBlock::set_values(const Eigen::VectorXd& values, State& state) const {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    FamilyState& own = state[place.family];
    (place.spread == nullptr ? own.means[place.column] : own.*place.spread) = values[i];
  }
}

double GroupBlock::log_prior(const State& state) const {
  double sum = 0.0;
  for (const Place& place : places_) {
    const FamilyPrior& prior = model_.family(place.family).prior;
    const FamilyState& own = state[place.family];
    if (place.spread == nullptr) {
      const double z = (own.means[place.column] - prior.mean) / prior.deviation;
      sum -= 0.5 * z * z;
    } else if (own.*place.spread < kSmallestSpread * prior.spread ||
               !std::isfinite(own.*place.spread)) {
      return -std::numeric_limits<double>::infinity();
    } else {
      sum += log_spread_prior(prior, own.*place.spread) - std::log(own.*place.spread);
    }
  }
  return sum;
}

}  // namespace haptrial::analysis::hierarchical
