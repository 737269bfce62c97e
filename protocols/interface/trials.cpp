#include "protocols/interface/trials.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "core/base/random.h"

namespace haptrial::protocols {

static std::uint64_t session_seed_of(const SessionPlace& place, std::uint64_t person) {
  return place.session > 1 ? derived_seed(person, fmt::format("session {}", place.session))
                           : person;
}

void give_seeds(SessionPlace& place, std::string_view hand) {
  place.person_seed = derived_seed(place.seed, "participant " + place.subject);
  place.session_seed = session_seed_of(place, place.person_seed);
  place.hand_person_seed = hand.empty() ? place.person_seed : derived_seed(place.person_seed, hand);
  place.hand_session_seed = session_seed_of(place, place.hand_person_seed);
}

FixedPlan::FixedPlan(std::vector<PlannedTrial> plan) : plan_(std::move(plan)) {}

Extent FixedPlan::extent(int most) const {
  Extent extent;
  std::set<std::int32_t> blocks;
  for (const PlannedTrial& trial : plan_) {
    if (most > 0 && !trial.practice && trial.trial > most) {
      continue;
    }
    ++(trial.practice ? extent.practice : extent.trials);
    if (!trial.practice) {
      blocks.insert(trial.block);
    }
  }
  extent.blocks = static_cast<int>(blocks.size());
  return extent;
}

}  // namespace haptrial::protocols
