#include "core/bone/simulator/injury_watch.h"

#include <algorithm>

namespace haptrial::bone {

bool begins(const LastInjury& before, const LastInjury& now) noexcept {
  return now.label != 0 && now.since < before.since &&
         (before.since > kOneInjury || now.label != before.label);
}

InjuryWatch::InjuryWatch(std::span<const Structure> structures) noexcept {
  for (std::size_t label = 1; label < std::min(structures.size(), vital_.size()); ++label) {
    vital_[label] = structures[label].vital;
  }
}

void InjuryWatch::tick(std::span<const EmptiedIn> emptied, std::span<const Tear> tears,
                       double dt) noexcept {
  last_.since += dt;
  for (const EmptiedIn& gone : emptied) {
    if (vital_[gone.label]) {
      last_ = {gone.label, 0.0};
    }
  }
  if (!tears.empty()) {
    last_ = {tears.back().label, 0.0};
  }
}

}  // namespace haptrial::bone
