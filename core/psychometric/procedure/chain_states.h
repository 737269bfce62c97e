#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

/// States of a track, each once. Two are the same when all but the number of trials is the same and
/// their levels differ by less than the resolution.
class ChainStates {
 public:
  /// @param most  states; more are std::invalid_argument
  ChainStates(const StaircaseParameters& parameters, std::size_t most);

  /// The index of a state; a new one is entered.
  std::size_t index_of(const StaircaseState& state);
  const StaircaseState& operator[](std::size_t index) const { return states_[index]; }
  std::size_t size() const noexcept { return states_.size(); }
  void clear();

 private:
  struct Key {
    std::int64_t x;
    std::int64_t counts;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const noexcept;
  };

  double origin_;
  double resolution_;  // [axis]
  std::size_t most_;
  std::vector<StaircaseState> states_;
  std::unordered_map<Key, std::size_t, Hash> index_;
};

}  // namespace haptrial::psychometric
