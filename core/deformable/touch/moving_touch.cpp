#include "core/deformable/touch/moving_touch.h"

#include <algorithm>
#include <utility>

#include "core/deformable/touch/ball_touch.h"

namespace haptrial::deformable {

using contact::ContactState;
using Eigen::Vector3d;

namespace {

constexpr std::uint64_t kTicksOfPicture = 8;
constexpr double kFar = 2.0;  // of the body's diagonal: no vertex of a whole body gets that far

TouchOptions felt_by(const MovingBody& body, TouchOptions options) {
  check(options);
  options.radius = std::max(options.radius, smallest_ball(*body.mesh));
  return options;
}

}  // namespace

MovingTouch::MovingTouch(SharedMovingBody body, const TouchOptions& options, double period,
                         std::shared_ptr<MovingShape> shape)
    : body_(std::move(body)),
      options_(felt_by(*body_, options)),
      period_(period),
      steps_(steps_on_a_tick(*body_, period)),
      motion_(motion_of(*body_, period)),
      ball_(*body_->mesh, options_, period),
      shape_(std::move(shape)),
      forces_(std::max(3 * BallContact::kMostPlaces, body_->mesh->grasped.size())),
      grip_(body_->mesh->grasped.size(), Vector3d::Zero()) {}

void MovingTouch::put_to_rest() noexcept {
  for (std::size_t v = 0; v < motion_->vertices(); ++v) {
    motion_->place(v, body_->mesh->tets.vertices[v]);
  }
  motion_->stop();
  ball_.forget();
  account_.open();
  contact_ = {};
  felt_.setZero();
  force_count_ = 0;
  upright_ = 0.0;
}

void MovingTouch::start(const Vector3d& tool) noexcept {
  put_to_rest();
  tool_ = grip_at_ = tool;
  contact_.proxy = tool;
}

void MovingTouch::adopt(const BodyTouch& before, const Vector3d& tool) noexcept {
  const auto* same = dynamic_cast<const MovingTouch*>(&before);
  if (same == nullptr || same->body_ != body_ || same->steps_ != steps_) {
    start(tool);
    return;
  }
  put_to_rest();
  motion_->adopt(*same->motion_);
  ball_.adopt(same->ball_);
  account_ = same->account_;
  contact_ = same->contact_;
  upright_ = same->upright_;
  grip_at_ = same->grip_at_;
  tool_ = same->tool_;
}

const contact::Contact& MovingTouch::tick(const Vector3d& tool, double) noexcept {
  if (!tool.allFinite()) {
    contact_.force.setZero();
    force_count_ = 0;
    return contact_;
  }
  const Vector3d way = tool - tool_;
  const Vector3d before = contact_.force;
  account_.book(contact_.force, way, period_);
  inverted_steps_ = motion_->inverted_steps();
  advance(tool);
  if (!together()) {
    ++counts_.flown_apart;
    const EnergyAccount account = account_;  // of the force that is taken off from here on
    start(tool);
    account_ = account;
    inverted_steps_ = motion_->inverted_steps();
  }
  note(tool);
  if (!grasps()) {
    bound_change(before, options_.stiffness * way.norm(), kFastestOfMoving * period_, contact_);
  }
  if (contact_.state != ContactState::kFree) {
    ++counts_.contact;
    counts_.crowded += ball_.crowded() ? 1 : 0;
    counts_.unsettled += ball_.solved() ? 0 : 1;
    limit();
  } else {
    account_.open();
  }
  tool_ = tool;
  if (shape_ && ticks_++ % kTicksOfPicture == 0) {
    shape_->write(*motion_);
  }
  return contact_;
}

/// The body steps while the ball goes from where the tool was to where it is.
void MovingTouch::advance(const Vector3d& tool) noexcept {
  felt_.setZero();
  std::ranges::fill(grip_, Vector3d::Zero());
  if (!grasps()) {
    ball_.gather(*motion_, tool_, tool);
  }
  for (int step = 1; step <= steps_; ++step) {
    const Vector3d hand = tool_ + static_cast<double>(step) / steps_ * (tool - tool_);
    if (grasps()) {
      pull(hand);
    } else {
      motion_->step();
      ball_.press(*motion_, hand);
      while (motion_->refine()) {
        ball_.press_again(*motion_, hand);
      }
      felt_ += ball_.force() / steps_;
    }
  }
}

/// A step with the grasped vertices where the hand has them.
void MovingTouch::pull(const Vector3d& hand) noexcept {
  const std::vector<std::int32_t>& grasped = body_->mesh->grasped;
  for (const std::int32_t vertex : grasped) {
    const auto v = static_cast<std::size_t>(vertex);
    motion_->place(v, body_->mesh->tets.vertices[v] + hand - grip_at_);
  }
  motion_->step();
  while (motion_->refine()) {
  }
  for (std::size_t i = 0; i < grasped.size(); ++i) {
    const Vector3d force = motion_->force(static_cast<std::size_t>(grasped[i])) / steps_;
    grip_[i] -= force;
    felt_ -= force;
  }
}

/// Whether every vertex that can be touched is where a whole body may have it; false, too, for what
/// is not a number.
bool MovingTouch::together() const noexcept {
  const double far = kFar * body_->mesh->box.diagonal().norm();
  bool together = felt_.allFinite();
  for (const Face& face : body_->mesh->felt) {
    const auto v = static_cast<std::size_t>(face[0]);
    together = together &&
               (motion_->position(v) - body_->mesh->tets.vertices[v]).squaredNorm() < far * far;
  }
  return together;
}

void MovingTouch::note(const Vector3d& tool) noexcept {
  contact_ = {};
  contact_.proxy = ball_.centre();
  force_count_ = 0;
  if (grasps()) {
    note_grip(tool);
    return;
  }
  if (ball_.places().empty() || felt_.isZero(0.0)) {
    return;
  }
  Vector3d normal = Vector3d::Zero();
  for (const BallContact::Place& place : ball_.places()) {
    normal -= std::max(0.0, place.sum.dot(place.normal)) * place.normal;
  }
  contact_.normal = normal.stableNormalized();
  contact_.depth = ball_.depth(tool);
  contact_.force = -felt_;
  contact_.settled = ball_.solved();
  contact_.state = ball_.slips() ? ContactState::kSlip : ContactState::kStick;
  keep_forces();
}

void MovingTouch::note_grip(const Vector3d& tool) noexcept {
  contact_.proxy = tool;
  if (felt_.isZero(0.0)) {
    return;
  }
  contact_.depth = (tool - grip_at_).norm();
  contact_.force = -felt_;
  contact_.normal = contact_.force.stableNormalized();
  contact_.state = ContactState::kStick;
  for (std::size_t i = 0; i < grip_.size(); ++i) {
    forces_[force_count_++] = {body_->mesh->grasped[i], grip_[i].cast<float>()};
  }
}

/// The mean over the tick's steps.
void MovingTouch::keep_forces() noexcept {
  for (const BallContact::Place& place : ball_.places()) {
    const SurfaceSamples::Sample& sample = ball_.sample(place);
    for (std::size_t k = 0; k < 3 && !place.sum.isZero(0.0); ++k) {
      const double weight = sample.weight[static_cast<Eigen::Index>(k)];
      if (weight > 0.0) {
        forces_[force_count_++] = {sample.corners[k], (weight / steps_ * place.sum).cast<float>()};
      }
    }
  }
}

/// A force that would turn a tetrahedron inside out is cut to what it was before, and one that
/// might give out more energy than there is to what may be given.
void MovingTouch::limit() noexcept {
  const double size = contact_.force.norm();
  if (motion_->inverted_steps() == inverted_steps_) {
    upright_ = size;
  } else {
    ++counts_.inverted;
    scale(size > upright_ ? upright_ / size : 1.0);
  }
  const double share = account_.share(contact_.force.norm());
  counts_.limited += share < 1.0 ? 1 : 0;
  scale(share);
}

void MovingTouch::scale(double share) noexcept { contact_.force *= share; }

}  // namespace haptrial::deformable
