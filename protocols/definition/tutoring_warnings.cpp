#include "protocols/definition/tutoring_warnings.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::protocols {

using tutoring::Passivity;

std::vector<std::string> tutoring_warnings(const Definition& definition) {
  const TutoringOptions& o = definition.tutoring;
  std::vector<std::string> warnings;
  if (o.passivity == Passivity::kTank && o.felt_back == 0.0 && o.authority == 1.0) {
    warnings.push_back(
        "tutoring.felt_back is 0, so who teaches gives no energy that could lead the other hand; "
        "add passivity = \"none\" where nobody is to feel anything back");
  }
  const bool both_feel = o.felt_back > 0.0 || (o.authority > 0.0 && o.authority < 1.0);
  if (o.passivity != Passivity::kNone || !both_feel) {
    return warnings;
  }
  const double damping = definition.hand.damping + o.gains.damping;
  double way = o.channel.delay + o.channel.jitter;
  for (const TutoringNetwork& network : o.networks) {
    way = std::max(way, network.channel.delay + network.channel.jitter);
  }
  const double delay = 2.0 * way;
  const double most = tutoring::stiffest_over_delay(damping, 1.0 / definition.rate, delay);
  if (o.gains.stiffness >= most) {
    warnings.push_back(fmt::format(
        "tutoring.stiffness is {:g} N/m without passivity control; over {:.0f} ms there and back "
        "two hands with {:g} N·s/m swing up from about {:.0f} N/m on, K < b / (T / 2 + T_d)",
        o.gains.stiffness, 1e3 * delay, damping, most));
  }
  return warnings;
}

}  // namespace haptrial::protocols
