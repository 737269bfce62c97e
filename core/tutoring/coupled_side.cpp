#include "core/tutoring/coupled_side.h"

#include <algorithm>
#include <cmath>

namespace haptrial::tutoring {

using Eigen::Vector3d;
using tutoring::Partner;

// After a loss the hand goes over from the partner's world to its own in this time [s].
static constexpr double kBackToOwnWorld = 0.05;
// A side that skipped ticks of its partner catches up within this time [s].
static constexpr double kLongestCatchUp = 0.05;

CoupledSide::CoupledSide(const SideParameters& parameters, const Vector3d& start)
    : p_(parameters),
      buffer_(std::make_unique<JitterBuffer>(parameters.late,
                                             std::llround(1e9 * parameters.longest_buffer))),
      tank_(parameters.tank),
      deadband_(parameters.deadband),
      last_place_(start) {}

void CoupledSide::hear(const TickMessage& message, std::int64_t now_ns) noexcept {
  if (!window_.accept(message.sequence)) {
    return;
  }
  energy_heard_ = std::max(energy_heard_, message.energy);
  if (message.echo_ns != 0) {
    clock_.add(message.echo_ns, message.sent_ns - message.held_ns, message.sent_ns, now_ns);
  }
  if (p_.even) {
    buffer_->put(message, now_ns);
  }
  if (message.sequence == window_.highest()) {
    newest_ = message;
    heard_ns_ = now_ns;
  }
}

void CoupledSide::look_at_link(std::int64_t now_ns, double dt) noexcept {
  const bool heard =
      window_.highest() > 0 && 1e-9 * static_cast<double>(now_ns - heard_ns_) < p_.deadline;
  if (linked_ && !heard) {
    ++losses_;
  }
  linked_ = heard;
  strength_ = heard ? std::min(1.0, strength_ + dt / p_.ramp)
                    : std::max(0.0, strength_ - dt / kBackToOwnWorld);
  stead_ = std::min(stead_ + dt / kBackToOwnWorld, 1.0 - strength_);
}

void CoupledSide::look_at_partner(std::int64_t now_ns, double dt) noexcept {
  const TickMessage* even = p_.even ? buffer_->take(now_ns) : nullptr;
  const TickMessage& message = even != nullptr ? *even : newest_;
  const bool is_new = message.sequence != used_.sequence;
  const double later = 1e-9 * static_cast<double>(message.sent_ns - used_.sent_ns);  // [s]
  const bool skips = used_.sequence > 0 && (p_.sparse ? message.sequence > used_.sequence + 1
                                                      : is_new && later > 1.5 * dt);
  used_for_ = is_new ? 0.0 : used_for_ + dt;
  used_ = message;
  const Partner sent{{message.position, message.velocity}, message.force};
  const Partner now = p_.sparse ? tutoring::expected(sent, used_for_, p_.deadband.keepalive) : sent;
  if (skips) {
    behind_ = {
        {partner_.tool.position - now.tool.position, partner_.tool.velocity - now.tool.velocity},
        partner_.force - now.force};
    catch_up_ = catching_up_ = std::min(later, kLongestCatchUp);
  }
  catching_up_ = std::max(0.0, catching_up_ - dt);
  partner_ = now;
  if (catching_up_ > 0.0) {
    const double share = catching_up_ / catch_up_;
    partner_.tool.position += share * behind_.tool.position;
    partner_.tool.velocity += share * behind_.tool.velocity;
    partner_.force += share * behind_.force;
  }
}

Vector3d CoupledSide::felt(const OwnState& own, double dt) noexcept {
  const Vector3d moved = stepped_ ? Vector3d(own.tool.position - last_place_) : Vector3d::Zero();
  last_place_ = own.tool.position;
  stepped_ = true;
  played_.setZero();
  played_stimulus_.setZero();
  const tutoring::Lead lead{1.0 - own.lead, own.felt_back};
  const double share =  // of the coupling that is on
      strength_ * std::clamp(std::max(lead.partner, lead.felt_back), 0.0, 1.0);
  if (strength_ <= 0.0) {
    tank_.let_go(moved, energy_heard_);
    return Vector3d::Zero();
  }
  const Vector3d whole =
      strength_ * tutoring::tutoring_force(p_.gains, lead, partner_, own.tool, Vector3d::Zero());
  const Vector3d wanted = share * tutoring::coupling_force(p_.gains, partner_.tool, own.tool);
  played_ = whole - wanted;
  played_stimulus_ =
      strength_ * std::clamp(lead.partner, 0.0, 1.0) * p_.gains.force_share * used_.stimulus;
  return p_.passivity == Passivity::kNone
             ? whole
             : played_ + tank_.limit(wanted, moved, own.tool.velocity, energy_heard_, dt, share);
}

/// A word about the session waits for no deadband.
bool CoupledSide::due(const OwnState& own, double dt) noexcept {
  const bool news = own.flags != told_flags_ || own.turn != told_turn_ || own.news;
  return !p_.sparse || deadband_.due({own.tool, own.force}, dt, news);
}

std::optional<TickMessage> CoupledSide::told(const OwnState& own, std::int64_t now_ns,
                                             double dt) noexcept {
  if (!due(own, dt)) {
    return std::nullopt;
  }
  told_flags_ = own.flags;
  told_turn_ = own.turn;
  TickMessage m;
  m.sequence = ++sent_;
  m.sent_ns = now_ns;
  m.echo_ns = window_.highest() > 0 ? newest_.sent_ns : 0;
  m.held_ns = window_.highest() > 0 ? now_ns - heard_ns_ : 0;
  m.position = own.tool.position;
  m.velocity = own.tool.velocity;
  m.force = p_.sparse ? deadband_.sent().force : own.force;
  m.stimulus = own.stimulus;
  m.energy = tank_.sent();
  m.lead = own.lead;
  m.world = own.world;
  m.buttons = own.buttons;
  m.flags = own.flags;
  m.turn = own.turn;
  return m;
}

CoupledSide::Output CoupledSide::step(const OwnState& own, std::int64_t now_ns,
                                      double dt) noexcept {
  look_at_link(now_ns, dt);
  look_at_partner(now_ns, dt);
  Output out;
  const double lead = std::clamp(own.lead, 0.0, 1.0);
  own_share_ = lead + (1.0 - lead) * stead_;
  out.force = felt(own, dt) + own_share_ * own.force;
  out.message = told(own, now_ns, dt);
  return out;
}

}  // namespace haptrial::tutoring
