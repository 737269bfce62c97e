#include "core/psychometric/procedure/chain_states.h"

#include <cmath>

#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

ChainStates::ChainStates(const StaircaseParameters& parameters, std::size_t most)
    : origin_(parameters.axis.at(parameters.low)),
      resolution_(1e-9 * (parameters.axis.at(parameters.high) - origin_)),
      most_(most) {}

std::size_t ChainStates::Hash::operator()(const Key& key) const noexcept {
  auto h = static_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15u;
  h ^= static_cast<std::uint64_t>(key.counts) + (h >> 29);
  h *= 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

std::size_t ChainStates::index_of(const StaircaseState& state) {
  // Counts of answers are at most 100, blocked steps 1000 and reversals 100,000: no two overlap.
  std::int64_t counts = state.reversals;
  counts = counts * 128 + state.right;
  counts = counts * 128 + state.wrong;
  counts = counts * 4 + (state.direction + 1);
  counts = counts * 1024 + state.blocked;
  const Key key{std::llround((state.x - origin_) / resolution_), counts};
  const auto [at, entered] = index_.try_emplace(key, states_.size());
  if (entered) {
    checks::require(states_.size() < most_, "Staircase",
                    "steps up and down lead to more levels than can be predicted; "
                    "let both be multiples of a common size");
    states_.push_back(state);
  }
  return at->second;
}

void ChainStates::clear() {
  states_.clear();
  index_.clear();
}

}  // namespace haptrial::psychometric
