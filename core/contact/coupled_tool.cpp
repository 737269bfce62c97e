#include "core/contact/coupled_tool.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

constexpr double kLeastSlip = 1e-4;  // friction below this speed is viscous [m/s]

Vector3d shortened(const Vector3d& v, double most) noexcept {
  const double length = v.norm();
  return length > most ? Vector3d(v * (most / length)) : v;
}

/// The turn from one orientation to another as a vector, in W [rad].
Vector3d turn_between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) noexcept {
  Eigen::Quaterniond q(to * from.transpose());
  q.coeffs() *= q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  return sine > 0.0 ? Vector3d(q.vec() * (2.0 * std::atan2(sine, q.w()) / sine))
                    : Vector3d(Vector3d::Zero());
}

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// How a point's way along its push follows from a step.
Vector6 along_of(const TouchingPoint& at) noexcept {
  Vector6 along;
  along << at.back, at.lever.cross(at.back);
  return along;
}

bool touches_after(const TouchingPoint& at, const Vector6& along, const Vector6& step) noexcept {
  return at.depth - along.dot(step) > 0.0;
}

}  // namespace

void CoupledTool::begin(const Eigen::Isometry3d& hand) noexcept {
  tool_ = hand;
  slip_.setZero();
}

/// Friction of a point: a damping that gives the limit μ k d at the slip of the last tick.
void CoupledTool::rub(const TouchingPoint& at, double dt, Matrix6& stiffness) const noexcept {
  Eigen::Matrix<double, 3, 6> slip;  // of the point, by the step
  slip.leftCols<3>().setIdentity();
  slip.rightCols<3>() << 0.0, at.lever.z(), -at.lever.y(), -at.lever.z(), 0.0, at.lever.x(),
      at.lever.y(), -at.lever.x(), 0.0;
  slip -= at.back * (at.back.transpose() * slip).eval();
  const double speed = std::max((slip * slip_).norm() / dt, kLeastSlip);
  const double limit = coupling_.friction * coupling_.contact_stiffness * at.depth;
  stiffness.noalias() += limit / (speed * dt) * (slip.transpose() * slip);
}

/// The step to where the energy is least if those points touch that do after a step.
CoupledTool::Step CoupledTool::step_with(const Eigen::Isometry3d& hand,
                                         std::span<const TouchingPoint> points,
                                         const Vector6& after, double dt) const noexcept {
  Matrix6 stiffness = Matrix6::Zero();
  stiffness.diagonal() << Vector3d::Constant(coupling_.stiffness),
      Vector3d::Constant(coupling_.turning_stiffness);
  Step step;
  Vector6 push;
  push << coupling_.stiffness * (hand.translation() - tool_.translation()),
      coupling_.turning_stiffness * turn_between(tool_.linear(), hand.linear());
  for (const TouchingPoint& at : points) {
    const Vector6 along = along_of(at);
    if (!touches_after(at, along, after)) {
      continue;
    }
    ++step.touching;
    stiffness.noalias() += coupling_.contact_stiffness * along * along.transpose();
    push += coupling_.contact_stiffness * at.depth * along;
    if (coupling_.friction > 0.0 && at.depth > 0.0) {
      rub(at, dt, stiffness);
    }
  }
  step.way = stiffness.ldlt().solve(push);
  return step;
}

/// A spring neither pulls a point that leaves nor comes a tick late to one that arrives: either
/// would give the hand energy.
CoupledTool::Step CoupledTool::step_to_rest(const Eigen::Isometry3d& hand,
                                            std::span<const TouchingPoint> points,
                                            double dt) const noexcept {
  constexpr int kMostSolutions = 8;
  Step step = step_with(hand, points, Vector6::Zero(), dt);
  for (int i = 1; i < kMostSolutions; ++i) {
    const Step next = step_with(hand, points, step.way, dt);
    if (next.way == step.way) {
      break;
    }
    step = next;
  }
  return step;
}

void CoupledTool::move(const Vector6& step) noexcept {
  const Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  if (angle > 0.0) {
    const Eigen::AngleAxisd about(angle, turn / angle);
    tool_.linear() = Eigen::Quaterniond(about * tool_.linear()).normalized().toRotationMatrix();
  }
  tool_.translation() += step.head<3>();
}

CoupledTool::Felt CoupledTool::follow(const Eigen::Isometry3d& hand,
                                      std::span<const TouchingPoint> points, double dt) noexcept {
  if (!hand.matrix().allFinite()) {
    return {};
  }
  const Step rest = step_to_rest(hand, points, dt);
  const Vector6& step = rest.way;
  const bool touches = rest.touching > 0;
  const Vector3d way =
      shortened(step.head<3>(), touches ? coupling_.most_step : coupling_.free_step);
  const Vector3d turn =
      shortened(step.tail<3>(), touches ? coupling_.most_turn : coupling_.free_turn);
  const bool with_hand = !touches && way == step.head<3>() && turn == step.tail<3>();
  slip_ << way, turn;
  if (with_hand) {
    tool_ = hand;  // and no rounding in between
  } else {
    move(slip_);
  }
  if (!touches) {
    return {};
  }
  return {coupling_.stiffness * (tool_.translation() - hand.translation()),
          coupling_.turning_stiffness * turn_between(hand.linear(), tool_.linear()), rest.touching};
}

}  // namespace haptrial::contact
