#include "protocols/psychophysics/subject/mark_by_hand.h"

#include <cmath>

#include "core/subject/perceiver/probing.h"
#include "protocols/psychophysics/definition/mark_means.h"

namespace haptrial::protocols {
namespace {

void reach(subject::ExplorationController& prober, double x, const PointState& hand) noexcept {
  prober.begin(subject::Reach{{x, 0.0, 0.0}, MarkByHand::kReach}, hand);
}

}  // namespace

void MarkByHand::begin(const MarkMeans& mark, double x, subject::ExplorationController& prober,
                       const PointState& hand) noexcept {
  constexpr double kNear = 0.1, kAway = 0.3;  // of the line
  x_ = x;
  time_ = 0.0;
  under_way_ = true;
  going_away_ = std::abs(hand.position.x() - x) < kNear * mark.length;
  reach(prober, going_away_ ? x - std::copysign(kAway * mark.length, x) : x, hand);
}

bool MarkByHand::tick(subject::ExplorationController& prober, const PointState& hand,
                      double dt) noexcept {
  constexpr double kHeld = 0.1;  // [s]
  time_ += dt;
  if (going_away_ && time_ > kReach) {
    going_away_ = false;
    time_ = 0.0;
    reach(prober, x_, hand);
  }
  const double pressed = time_ - kReach - kRest;
  return !going_away_ && pressed > 0.0 && pressed < kHeld;
}

}  // namespace haptrial::protocols
