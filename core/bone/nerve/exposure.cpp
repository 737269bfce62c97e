#include "core/bone/nerve/exposure.h"

#include <algorithm>
#include <cmath>

namespace haptrial::nerve {

NerveEvents IrritatedNerve::step(const Exposure& e, double dt) noexcept {
  const double away = std::max(0.0, e.distance);
  const double gain = p_.warming * e.power * std::exp(-away / p_.heat_reach);
  warmth_ += (gain - warmth_ / p_.cooling) * dt;
  const bool works = e.drilling || e.suction;
  const double burst_rate = works ? p_.bursts * std::exp(-away / p_.reach) *
                                        (1.0 + p_.per_force * e.force + p_.per_speed * e.speed)
                                  : 0.0;
  const double train_rate = p_.trains * std::max(0.0, warmth_ - p_.harmless);
  NerveEvents events;
  // The same draws each tick, so that what comes later does not hang on what came before.
  events.burst = random_.uniform() < -std::expm1(-burst_rate * dt);
  events.train = random_.uniform() < -std::expm1(-train_rate * dt);
  events.severity = random_.uniform();
  const bool touches = e.distance <= 0.0;
  if (touches && !touched_) {
    events.burst = true;
    events.train = events.train || e.force > 0.5;  // [N] a graze bursts, a push injures
    events.severity = std::max(events.severity, std::min(1.0, 0.5 * e.force));
  }
  touched_ = touches;
  return events;
}

}  // namespace haptrial::nerve
