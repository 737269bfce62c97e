#include "core/tutoring/deadband.h"

#include <algorithm>

#include "core/base/longer.h"

namespace haptrial::tutoring {

Partner expected(const Partner& sent, double since, double most) noexcept {
  Partner now = sent;
  now.tool.position += std::min(since, most) * sent.tool.velocity;
  if (since > most) {
    now.tool.velocity.setZero();
  }
  return now;
}

/// @param most  that the force may be wrong by [N]
bool Deadband::wrong(const Partner& now, double most) const noexcept {
  const Partner heard = held();
  return longer(now.force - heard.force, most) ||
         longer(now.tool.position - heard.tool.position, p_.place);
}

bool Deadband::due(const Partner& now, double dt, bool news) noexcept {
  since_ += dt;
  const bool first = ticks_++ == 0;
  const double most = std::max(p_.force_fraction * now.force.norm(), p_.least_force);
  forces_.add(now.force);
  if (!first && !news && since_ < p_.keepalive && !wrong(now, most)) {
    return false;
  }
  sent_ = now;
  sent_.force = forces_.choose(most);
  since_ = 0.0;
  ++messages_;
  return true;
}

}  // namespace haptrial::tutoring
