#include "protocols/definition/tutoring_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/table.h"
#include "protocols/definition/definition.h"

namespace haptrial::protocols {

using network::Passivity;

static void read_link_options(Table& table, TutoringOptions& o) {
  o.authority = table.number_or("authority", o.authority, {0.0, 1.0}, "1");
  o.felt_back = table.number_or("felt_back", o.felt_back, {0.0, 1.0}, "1");
  if (table.has("passivity")) {
    const std::string how = table.choice("passivity", {"tank", "waves", "none"});
    o.passivity = how == "tank"    ? Passivity::kTank
                  : how == "waves" ? Passivity::kWaves
                                   : Passivity::kNone;
  }
  if (table.has("deadband")) {
    o.deadband = table.boolean("deadband");
    if (o.deadband && o.passivity == Passivity::kWaves) {
      table.reject("deadband", "true",
                   "false with passivity = \"waves\", which need every message");
    }
  }
  if (table.has("jitter_buffer")) {
    o.jitter_buffer = table.boolean("jitter_buffer");
  }
  o.deadline = table.number_or("deadline", o.deadline, {0.01, 5.0}, "s");
  o.patience = table.number_or("patience", o.patience, {1.0, 600.0}, "s");
  if (table.has("channel")) {
    Table channel = table.table("channel");
    o.channel = network::read_channel_conditions(channel);
  }
}

TutoringOptions read_tutoring_options(Table& table) {
  TutoringOptions o;
  o.gains.stiffness = table.number_or("stiffness", o.gains.stiffness, {0.0, 1000.0}, "N/m");
  o.gains.damping = table.number_or("damping", o.gains.damping, {0.0, 100.0}, "N·s/m");
  o.gains.force_share = table.number_or("force_share", o.gains.force_share, {0.0, 1.0}, "1");
  o.ramp = table.number_or("ramp", o.ramp, {0.05, 10.0}, "s");
  o.speed = table.number_or("speed", o.speed, {0.5, 1.0}, "1");
  read_link_options(table, o);
  return o;
}

network::SideParameters side_parameters(const TutoringOptions& o) {
  network::SideParameters p;
  p.gains = o.gains;
  p.passivity = o.passivity;
  p.sparse = o.deadband;
  p.even = o.jitter_buffer;
  p.deadline = o.deadline;
  p.ramp = o.ramp;
  return p;
}

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
  const double delay = 2.0 * (o.channel.delay + o.channel.jitter);
  const double most = control::stiffest_over_delay(damping, 1.0 / definition.rate, delay);
  if (o.gains.stiffness >= most) {
    warnings.push_back(fmt::format(
        "tutoring.stiffness is {:g} N/m without passivity control; over {:.0f} ms there and back "
        "two hands with {:g} N·s/m swing up from about {:.0f} N/m on, K < b / (T / 2 + T_d)",
        o.gains.stiffness, 1e3 * delay, damping, most));
  }
  return warnings;
}

}  // namespace haptrial::protocols
