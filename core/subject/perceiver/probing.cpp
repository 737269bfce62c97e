#include "core/subject/perceiver/probing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/control/pd_controller.h"

namespace haptrial::subject {
namespace {

constexpr double kFrictionSpeed = 0.005;    // over which the handle's friction is overcome [m/s]
constexpr double kPositionGain = 200.0;     // kp [N/m]
constexpr double kVelocityGain = 20.0;      // kd [N·s/m]
constexpr double kIntegralGain = 2500.0;    // while a place is kept [N/(m·s)]
constexpr double kMostFeedback = 6.0;       // [N]
constexpr double kHoldBack = 300.0;         // of a press beyond its travel [N/m]
constexpr double kMostTravel = 0.05;        // of a press while the hand strokes or palpates [m]
constexpr double kPressOfStrokeRise = 0.3;  // [s]

/// s of the minimum-jerk move at u = 0 to 1, and its derivatives by u.
struct Smooth {
  double s, rate, second;
};
Smooth smooth_step(double u) noexcept {
  if (u >= 1.0) {
    return {1.0, 0.0, 0.0};
  }
  const double u2 = u * u;
  return {u * u2 * (10.0 - 15.0 * u + 6.0 * u2), 30.0 * u2 * (1.0 - 2.0 * u + u2),
          60.0 * u * (1.0 - 3.0 * u + 2.0 * u2)};
}

void require_above(double value, double bound, bool also_at_bound, const char* name) {
  if (!std::isfinite(value) || value < bound || (value == bound && !also_at_bound)) {
    throw std::invalid_argument(std::string(name) + " must be finite and " +
                                (also_at_bound ? "at least" : "above") + " 0");
  }
}

void require_direction(const Eigen::Vector3d& v, const char* name) {
  if (!v.allFinite() || !(v.norm() > 0.0)) {
    throw std::invalid_argument(std::string(name) + " must be finite and longer than 0");
  }
}

struct Checker {
  void operator()(const Rest&) const {}
  void operator()(const Hold&) const {}
  void operator()(const Press& p) const {
    require_direction(p.direction, "press: direction");
    require_above(p.force, 0.0, true, "press: force");
    require_above(p.rise, 0.0, false, "press: rise");
    require_above(p.travel, 0.0, false, "press: travel");
  }
  void operator()(const Stroke& p) const {
    require_direction(p.direction, "stroke: direction");
    require_direction(p.normal, "stroke: normal");
    require_above(p.half_length, 0.0, false, "stroke: half_length");
    require_above(p.frequency, 0.0, false, "stroke: frequency");
    require_above(p.force, 0.0, true, "stroke: force");
    if (p.direction.normalized().cross(p.normal.normalized()).norm() < 1e-3) {
      throw std::invalid_argument("stroke: normal must not be along direction");
    }
  }
  void operator()(const Reach& p) const {
    if (!p.to.allFinite()) {
      throw std::invalid_argument("reach: to must be finite");
    }
    require_above(p.duration, 0.0, false, "reach: duration");
  }
  void operator()(const Pursue& p) const { require_above(p.lag, 0.0, false, "pursue: lag"); }
  void operator()(const Contour& p) const {
    require_direction(p.towards, "follow: towards");
    for (const Eigen::Vector3d& axis : p.around) {
      require_direction(axis, "follow: around");
    }
    if (p.towards.normalized().cross(p.around[0].normalized()).norm() < 1e-3) {
      throw std::invalid_argument("follow: around must not be along towards");
    }
    require_above(p.turn_after, 0.0, false, "follow: turn_after");
    require_above(p.speed, 0.0, false, "follow: speed");
    require_above(p.force, 0.0, false, "follow: force");
  }
  void operator()(const Palpate& p) const { subject::check(p); }
};

constexpr double kLetGo = 0.1;  // after a reaction time people no longer resist what has gone [s]

/// The push of an arm along `direction` (unit) that holds back beyond `travel` from where it began,
/// so that a push into nothing ends. [N]
Eigen::Vector3d press_to(double force, double travel, const Eigen::Vector3d& direction,
                         const Eigen::Vector3d& way) noexcept {
  return (force - kHoldBack * std::max(0.0, way.dot(direction) - travel)) * direction;
}

}  // namespace

void check(const Probe& probe) { std::visit(Checker{}, probe); }

void ExplorationController::begin(const Probe& probe, const PointState& hand) noexcept {
  probe_ = probe;
  start_ = hand.position;
  posture_ = hand.position;
  carried_ += integral_;
  integral_.setZero();
  desired_ = {hand.position, Eigen::Vector3d::Zero()};
  lead_ = hand.position;
  time_ = 0.0;
  if (const auto* contour = std::get_if<Contour>(&probe)) {
    follower_.begin(*contour, hand.position);
  }
}

ExplorationController::Aim ExplorationController::aim(const Rest&, const HandSensation&) noexcept {
  return {};
}

ExplorationController::Aim ExplorationController::aim(const Hold&, const HandSensation&) noexcept {
  Aim aim;
  aim.keeps_place = true;
  return aim;
}

ExplorationController::Aim ExplorationController::aim(const Press& press,
                                                      const HandSensation& now) noexcept {
  Aim aim;
  aim.free = press.direction.normalized();
  aim.push = press_to(press.force * smooth_step(time_ / press.rise).s, press.travel, aim.free,
                      now.hand.position - start_);
  return aim;
}

ExplorationController::Aim ExplorationController::aim(const Stroke& stroke,
                                                      const HandSensation& now) noexcept {
  Aim aim;
  Eigen::Vector3d u = stroke.direction.normalized();
  if (stroke.force > 0.0) {
    aim.free = stroke.normal.normalized();
    aim.push = press_to(stroke.force * smooth_step(time_ / kPressOfStrokeRise).s, kMostTravel,
                        aim.free, now.hand.position - start_);
    u = (u - u.dot(aim.free) * aim.free).normalized();
  }
  // The product of the growth r and the sine, by its rule.
  const double omega = 2.0 * std::numbers::pi * stroke.frequency;
  const double growth_rate = 2.0 * stroke.frequency;  // over half a cycle
  const Smooth r = smooth_step(growth_rate * time_);
  const double sine = std::sin(omega * time_);
  const double cosine = std::cos(omega * time_);
  const double r1 = r.rate * growth_rate;
  const double r2 = r.second * growth_rate * growth_rate;
  const double a = stroke.half_length;
  desired_.position = start_ + a * r.s * sine * u;
  desired_.velocity = a * (r1 * sine + r.s * omega * cosine) * u;
  aim.acceleration = a * (r2 * sine + 2.0 * r1 * omega * cosine - r.s * omega * omega * sine) * u;
  return aim;
}

ExplorationController::Aim ExplorationController::aim(const Reach& reach,
                                                      const HandSensation&) noexcept {
  Aim aim;
  const Eigen::Vector3d way = reach.to - start_;
  const Smooth s = smooth_step(time_ / reach.duration);
  desired_.position = start_ + s.s * way;
  desired_.velocity = s.rate / reach.duration * way;
  aim.acceleration = s.second / (reach.duration * reach.duration) * way;
  aim.keeps_place = time_ >= reach.duration;
  return aim;
}

ExplorationController::Aim ExplorationController::aim(const Pursue& pursue,
                                                      const HandSensation& now) noexcept {
  Aim aim;
  const double each = 0.5 * pursue.lag;  // time constant
  aim.acceleration = (lead_ - desired_.position) / (each * each) - 2.0 / each * desired_.velocity;
  desired_.velocity += now.dt * aim.acceleration;
  desired_.position += now.dt * desired_.velocity;
  return aim;
}

/// The hand goes on from wherever it is, but keeps to the plane of its loop.
ExplorationController::Aim ExplorationController::aim(const Contour&,
                                                      const HandSensation& now) noexcept {
  Aim aim;
  const ContourFollower::Step step = follower_.step(time_, now.hand, now.felt, now.dt);
  desired_.position = now.hand.position + step.off_loop;
  desired_.velocity = step.velocity;
  aim.push = step.push;
  return aim;
}

/// Aim from place to place as in a reach; at a place it keeps to the line along which it presses.
ExplorationController::Aim ExplorationController::aim(const Palpate& palpate,
                                                      const HandSensation& now) noexcept {
  Aim aim;
  const PalpationStep step = palpation_at(palpate, time_);
  const Eigen::Vector3d& from = step.place == 0 ? start_ : palpate.places[step.place - 1];
  const Eigen::Vector3d way = palpate.places[step.place] - from;
  const Smooth s = smooth_step(step.moved);
  desired_.position = from + s.s * way;
  desired_.velocity = s.rate / palpate.move * way;
  aim.acceleration = s.second / (palpate.move * palpate.move) * way;
  if (step.pressing) {
    aim.free = palpate.direction.normalized();
    aim.push = press_to(palpate.force * smooth_step(step.pressed).s, kMostTravel, aim.free,
                        now.hand.position - palpate.places[step.place]);
  }
  return aim;
}

Eigen::Vector3d ExplorationController::track(const Aim& aim, const PointState& hand,
                                             double dt) noexcept {
  const Eigen::Vector3d error = desired_.position - hand.position;
  if (aim.keeps_place) {
    integral_ = control::saturate(integral_ + kIntegralGain * dt * error, kMostFeedback);
  }
  const Eigen::Vector3d feedback =
      kPositionGain * error + kVelocityGain * (desired_.velocity - hand.velocity) + integral_;
  const Eigen::Vector3d own =
      (hand_.hand_mass + hand_.handle_mass) * aim.acceleration + hand_.damping * desired_.velocity +
      hand_.stiffness * (desired_.position - posture_) +
      hand_.coulomb_friction * (desired_.velocity / kFrictionSpeed).array().tanh().matrix();
  posture_ += dt / hand_.posture_time * (desired_.position - posture_);
  const Eigen::Vector3d force = control::saturate(feedback, kMostFeedback) + own;
  return force - force.dot(aim.free) * aim.free;
}

HandCommand ExplorationController::command(const PointState& hand, double dt,
                                           const Eigen::Vector3d& felt) noexcept {
  time_ += dt;
  const HandSensation now{hand, felt, dt};
  const Aim wanted = std::visit([&](const auto& probe) { return aim(probe, now); }, probe_);
  HandCommand command;
  carried_ *= std::exp(-dt / kLetGo);
  if (!std::holds_alternative<Rest>(probe_)) {
    command.force = wanted.push + track(wanted, hand, dt);
  }
  command.force += carried_;
  if (noise_) {
    command.force = noise_->press(1.0) * command.force + noise_->tremor();
  }
  return command;
}

}  // namespace haptrial::subject
