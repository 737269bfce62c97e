#include "protocols/tutoring/linked_hand.h"

#include <algorithm>
#include <cmath>

#include "core/base/longer.h"
#include "core/control/pd_controller.h"

namespace haptrial::protocols {

void LinkQuality::hear(const tutoring::Arrived& arrived) noexcept {
  constexpr double kShare = 1.0 / 16.0;  // of the newest, as in RFC 3550
  const std::int64_t transit = arrived.time_ns - arrived.message.sent_ns;
  if (begun_) {
    const double change = 1e-9 * std::abs(static_cast<double>(transit - transit_));
    jitter_ += kShare * (change - jitter_);
  }
  transit_ = transit;
  begun_ = true;
}

void LinkQuality::step(const tutoring::SequenceWindow& window, std::int64_t now_ns) noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (now_ns < second_ends_) {
    return;
  }
  const std::uint64_t sent = window.highest() - highest_;
  const std::uint64_t came = window.accepted() - accepted_;
  const bool first = second_ends_ == 0;
  loss_ = first || sent == 0
              ? 0.0
              : std::clamp(1.0 - static_cast<double>(came) / static_cast<double>(sent), 0.0, 1.0);
  highest_ = window.highest();
  accepted_ = window.accepted();
  second_ends_ = now_ns + kSecond;
}

using tutoring::PassBarrier;
using tutoring::TickFlag;
using tutoring::TickMessage;
using tutoring::TurnPhase;

LinkedHand::LinkedHand(const Parts& parts)
    : p_(parts),
      side_(side_parameters(parts.options)),
      stream_(parts.payload != nullptr ? std::make_unique<tutoring::ReliableStream>() : nullptr),
      coupled_(parts.options.ramp),
      claim_(parts.options.ramp),
      taught_(parts.options.ramp, parts.options.authority) {}

void LinkedHand::hear(const tutoring::Arrived& arrived) noexcept {
  ++arrived_;
  quality_.hear(arrived);
  side_.hear(arrived.message, arrived.time_ns);
  if (stream_) {
    stream_->hear(arrived.message.stream);
  }
  // The last words of a session come without a number of their own order.
  ever_over_ = ever_over_ || (arrived.message.flags & TickFlag::kOver) != 0;
  ever_left_ = ever_left_ || (arrived.message.flags & TickFlag::kLeft) != 0;
}

void LinkedHand::listen() noexcept {
  now_ = p_.wire.tick();
  first_now_ = first_now_ == 0 ? now_ : first_now_;
  arrived_ = 0;
  p_.wire.receive(*this);
  if (stream_) {
    stream_->deliver(*p_.payload);
  }
  quality_.step(side_.sequence(), now_);
  heed_partner();
  listened_ = true;
}

void LinkedHand::heed_partner() noexcept {
  const bool stops = (side_.newest().flags & TickFlag::kStop) != 0;
  if (stops && !stop_seen_) {
    stopped_by_partner_.store(true, std::memory_order_relaxed);
    p_.stop();
  }
  stop_seen_ = stops;
}

void LinkedHand::await(std::uint32_t item) noexcept {
  turns_.begin(item);
  begun_ = false;
  stopped_by_partner_.store(false, std::memory_order_relaxed);
}

bool LinkedHand::decided() const noexcept {
  return !turns_.open() || turns_.own().phase != TurnPhase::kReady;
}

PassBarrier::Step LinkedHand::begin_tick(bool own_done, bool holds) noexcept {
  listen();
  if (turns_.open()) {  // else it was aborted before it began
    step_ = turns_.step(side_.newest().turn, own_done, alone() || (own_done && !holds));
  }
  return step_;
}

/// The partner's authority over the own hand, from none to all of it and back by a ramp.
void LinkedHand::share_lead(bool engaged, double dt) noexcept {
  const int asked = lead_asked_.load(std::memory_order_relaxed);
  const bool other_claims = (side_.newest().flags & TickFlag::kClaim) != 0;
  coupled_.ask(engaged ? 1.0 : 0.0);
  coupled_.step(dt);
  claim_.ask(claims() ? 1.0 : 0.0);
  claim_.step(dt);
  double partner = 0.0;
  if (p_.role == LinkRole::kTeaches) {
    const double authority = asked < 0 ? p_.options.authority : static_cast<double>(asked);
    taught_.ask(other_claims ? 0.0 : authority);
    partner = 1.0 - taught_.step(dt);
  } else {
    partner = side_.newest().lead * (1.0 - claim_.share());
  }
  own_.lead = 1.0 - coupled_.share() * partner;
  own_.felt_back = coupled_.share() * p_.options.felt_back;
}

std::uint32_t LinkedHand::flags() const noexcept {
  const bool stopped =
      fault_ == device::Fault::kEmergencyStop || fault_ == device::Fault::kStopButton;
  std::uint32_t flags = 0;
  const auto set = [&flags](bool on, TickFlag flag) { flags |= on ? std::uint32_t{flag} : 0U; };
  set(runs_, TickFlag::kEngaged);
  set(stopped, TickFlag::kStop);
  set(fault_ != device::Fault::kNone, TickFlag::kFault);
  set(claims(), TickFlag::kClaim);
  return flags;
}

void LinkedHand::step(const PointState& tool, const Eigen::Vector3d& own_force,
                      const Eigen::Vector3d& own_stimulus, std::uint32_t buttons,
                      double dt) noexcept {
  own_.tool = tool;
  own_.force = own_force;
  own_.stimulus = own_stimulus;
  own_.buttons = buttons;
  own_.flags = flags();
  own_.turn = turns_.own();
  own_.news = stream_ && stream_->wants(*p_.payload, now_, side_.clock().round_trip());
  tutoring::CoupledSide::Output out = side_.step(own_, now_, dt);
  coupling_ = out.force - side_.own_share() * own_force;
  sent_ = out.message ? static_cast<std::int64_t>(out.message->sequence) : 0;
  if (out.message) {
    if (stream_) {
      stream_->fill(out.message->stream, now_);
    }
    p_.wire.send(*out.message);
  }
}

void LinkedHand::couple(PassOutput& out, const device::DeviceReading& reading, double dt) noexcept {
  const bool first_phase =
      turns_.own().item % PassBarrier::kPhases == 0;  // what follows may be a test
  runs_ = first_phase && out.stage == record::Stage::kRun;
  const bool partner_runs = (side_.newest().flags & TickFlag::kEngaged) != 0;
  share_lead(runs_ && partner_runs && turns_.together() && side_.linked(), dt);
  step(reading.tool, out.force, out.intent.stimulus, reading.buttons, dt);
  const double passed = keep_within_envelope(out);
  // The tank watches the force of the link; the own world's part as it always is. A share that
  // changes puts energy into the own world's springs, or takes it out.
  const double share = side_.own_share();
  out.intent.push = share * out.intent.push + coupling_;
  out.intent.added = share * out.intent.added + (share - last_share_) * out.intent.stored;
  out.intent.stored *= share;
  // Stimuli count as much as they are felt: the envelope takes them for part of the force.
  out.intent.stimulus = passed * (share * out.intent.stimulus + side_.played_stimulus());
  out.intent.ended *= last_share_;
  last_share_ = share;
}

/// A partner far away pulls hard, which is no fault of the own protocol. Without coupling the own
/// force stays as it is.
/// @returns the share of the force that passes
double LinkedHand::keep_within_envelope(PassOutput& out) noexcept {
  const Eigen::Vector3d own_part = side_.own_share() * out.force;
  const Eigen::Vector3d wanted = own_part + coupling_;
  out.force = wanted;
  if (coupling_ != Eigen::Vector3d::Zero() && longer(wanted, p_.options.most_force)) {
    out.force = control::saturate(wanted, p_.options.most_force);
    out.saturated = true;
    coupling_ = out.force - own_part;
    return p_.options.most_force / wanted.norm();
  }
  return 1.0;
}

void LinkedHand::observe(const stimulus::Shown& /*shown*/, const stimulus::Forces& forces,
                         double dt) noexcept {
  acts_ = forces[0];
  dt_ = dt;
}

/// Between passes nothing is felt of the partner, but everything is heard and told.
void LinkedHand::record(std::uint64_t sequence, const Readings& readings,
                        device::Fault fault) noexcept {
  fault_ = fault;
  const bool in_pass = listened_;
  if (!in_pass) {
    listen();
    runs_ = false;
    if (begun_) {
      turns_.abort();  // a fault, or somebody broke it off
    } else if (turns_.open()) {
      step_ = turns_.step(side_.newest().turn, false, alone());
    }
    coupled_ = tutoring::Handover(p_.options.ramp);
    share_lead(false, dt_);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    step(readings[0].tool, none, none, readings[0].buttons, dt_);
    coupling_.setZero();
    last_share_ = 1.0;
  }
  side_.acts(in_pass ? Eigen::Vector3d(acts_ - side_.own_share() * own_.force)
                     : Eigen::Vector3d::Zero());
  listened_ = false;
  keep_row(sequence);
  tell_state(dt_);
  if (p_.inner != nullptr) {
    p_.inner->record(sequence, readings, fault);
  }
}

void LinkedHand::keep_row(std::uint64_t sequence) noexcept {
  const TickMessage& used = side_.used();
  const tutoring::ClockOffset& clock = side_.clock();
  const std::int64_t offset = clock.known() ? clock.offset(now_) : 0;
  record::LinkRow row;
  row.sequence = sequence;
  row.sent = sent_;
  row.heard = static_cast<std::int64_t>(used.sequence);
  row.arrived = arrived_;
  row.lost = static_cast<std::int32_t>(side_.sequence().missing());
  const auto bit = [&row](bool on, record::LinkState state) {
    row.state = static_cast<std::uint8_t>(row.state | (on ? state : 0));
  };
  bit(side_.linked(), record::kLinked);
  bit(coupled_.share() > 0.0, record::kLinkEngaged);
  bit((side_.newest().flags & TickFlag::kStop) != 0, record::kPartnerStops);
  bit((side_.newest().flags & TickFlag::kFault) != 0, record::kPartnerFault);
  bit((side_.newest().flags & TickFlag::kClaim) != 0, record::kPartnerClaims);
  row.lead = own_.lead;
  row.delay = used.sequence > 0 && clock.known()
                  ? 1e-9 * static_cast<double>(now_ - (used.sent_ns - offset))
                  : 0.0;
  row.round_trip = clock.round_trip() < 0 ? -1.0 : 1e-9 * static_cast<double>(clock.round_trip());
  row.clock_offset = 1e-9 * static_cast<double>(offset);
  row.clock_drift = clock.drift();
  row.position = used.position;
  row.velocity = used.velocity;
  row.force = used.force;
  row.coupling = coupling_;
  row.energy = side_.tank().level();
  row.energy_given = side_.tank().given();
  row.energy_sent = side_.tank().sent();
  row.energy_received = side_.energy_heard();
  log_.push(row);
}

/// About 20 times a second, and when it matters at once.
void LinkedHand::tell_state(double dt) noexcept {
  constexpr double kBetween = 0.05;  // [s]
  untold_ += dt;
  if (untold_ < kBetween && !ever_left_ && !stop_seen_) {
    return;
  }
  untold_ = 0.0;
  const tutoring::ClockOffset& clock = side_.clock();
  record::PartnerState s;
  s.heard = side_.sequence().highest() > 0;
  s.linked = side_.linked();
  s.coupled = coupled_.share() > 0.0;
  s.claims = claims();
  s.other_claims = (side_.newest().flags & TickFlag::kClaim) != 0;
  s.over = alone();
  // Whoever leaves after a pass that both completed has done all that was asked of it.
  // A world that both work on cannot be gone on with alone.
  s.left = (ever_left_ || (stream_ && alone())) && turns_.open();
  s.stops = stop_seen_;
  s.silence = 1e-9 * static_cast<double>(now_ - (s.heard ? side_.heard_ns() : first_now_));
  s.lead = own_.lead;
  s.round_trip = clock.round_trip() < 0 ? -1.0 : 1e-9 * static_cast<double>(clock.round_trip());
  s.jitter = quality_.jitter();
  s.loss = quality_.loss();
  s.energy = side_.tank().level();
  s.clock_offset = clock.known() ? 1e-9 * static_cast<double>(clock.offset(now_)) : 0.0;
  s.clock_drift = clock.drift();
  s.losses = side_.losses();
  told_.write(s);
}

const record::PartnerState& LinkedHand::state() noexcept {
  told_.read(read_);
  return read_;
}

TickMessage LinkedHand::last_words(tutoring::TickFlag flag) const noexcept {
  TickMessage m;
  m.sequence = side_.messages() + 1;
  m.position = own_.tool.position;
  m.lead = 1.0;
  m.energy = side_.tank().sent();
  m.turn = turns_.own();
  m.flags = flags() & ~static_cast<std::uint32_t>(TickFlag::kEngaged);
  m.flags |= flag;
  return m;
}

}  // namespace haptrial::protocols
