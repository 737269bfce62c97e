#include "core/deformable/touch/ball_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr double kContactSampled = 0.4;  // of the radius: how far places are apart, about
constexpr double kContactAhead = 0.25;   // of a cell: what is that near may be pressed on the tick
constexpr double kNear = 0.05;           // of a cell: likewise on the step
constexpr double kContactCompliance = 1e-6;  // added to each place's: two places may be one
constexpr int kRounds = 2;                   // of pressures and friction on a step
constexpr double kGrowth = 0.02;             // of a ball that had shrunk [m/s]

int places_along_a_cell(const HapticMesh& mesh, double radius) {
  return static_cast<int>(std::ceil(mesh.spacing / (kContactSampled * radius)));
}

std::size_t as_size(std::int32_t i) { return static_cast<std::size_t>(i); }

Vector3d across(const Vector3d& v, const Vector3d& n) { return v - v.dot(n) * n; }

}  // namespace

BallContact::BallContact(const HapticMesh& mesh, const TouchOptions& options, double period)
    : mesh_(&mesh),
      options_(options),
      samples_(mesh.felt, mesh.tets.vertices, places_along_a_cell(mesh, options.radius)),
      growth_(kGrowth * period),
      radius_(options.radius) {
  std::set<std::int32_t> corners;
  for (const Face& face : mesh.felt) {
    corners.insert(face.begin(), face.end());
  }
  corners_.assign(corners.begin(), corners.end());
  near_.assign(mesh.tets.vertices.size(), 0);
  looked_at_.assign(samples_.samples.size(), 0);
  kept_.assign(samples_.samples.size(), 0.0);
}

void BallContact::forget() noexcept {
  for (const Place& place : places()) {
    kept_[as_size(place.sample)] = 0.0;
  }
  count_ = 0;
  pressure_ = 0.0;
  radius_ = options_.radius;
  force_.setZero();
  friction_.setZero();
}

void BallContact::adopt(const BallContact& before) noexcept {
  forget();
  if (before.samples_.samples.size() == samples_.samples.size()) {
    places_ = before.places_;
    count_ = before.count_;
    centre_ = before.centre_;
    force_ = before.force_;
    friction_ = before.friction_;
    pressure_ = before.pressure_;
    radius_ = before.radius_;
  }
}

Vector3d BallContact::where(const BodyMotion& motion, std::int32_t sample) const noexcept {
  const SurfaceSamples::Sample& s = samples_.samples[as_size(sample)];
  return s.weight[0] * motion.position(as_size(s.corners[0])) +
         s.weight[1] * motion.position(as_size(s.corners[1])) +
         s.weight[2] * motion.position(as_size(s.corners[2]));
}

Vector3d BallContact::at_rest(std::int32_t sample) const noexcept {
  const SurfaceSamples::Sample& s = samples_.samples[as_size(sample)];
  Vector3d p = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    p += s.weight[static_cast<Eigen::Index>(k)] * mesh_->tets.vertices[as_size(s.corners[k])];
  }
  return p;
}

void BallContact::gather(const BodyMotion& motion, const Vector3d& from,
                         const Vector3d& to) noexcept {
  ++tick_;
  crowded_ = false;
  slips_ = false;
  solved_ = true;
  std::array<std::int32_t, kMostPlaces> had{};
  const std::size_t had_count = count_;
  for (std::size_t i = 0; i < had_count; ++i) {
    had[i] = places_[i].sample;
    kept_[as_size(had[i])] = places_[i].pressed;
  }
  count_ = 0;
  const Vector3d middle = 0.5 * (from + to);
  const double reach = options_.radius + 0.5 * (to - from).norm() + kContactAhead * mesh_->spacing;
  find_near(motion, middle, reach + std::numbers::sqrt2 * mesh_->spacing);
  for (std::size_t f = 0; f < mesh_->felt.size(); ++f) {
    const Face& face = mesh_->felt[f];
    if (near_[as_size(face[0])] + near_[as_size(face[1])] + near_[as_size(face[2])] > 0) {
      for (const std::int32_t number : samples_.on(static_cast<std::int32_t>(f))) {
        look_at(motion, number, middle, reach);
      }
    }
  }
  for (std::size_t i = 0; i < had_count; ++i) {
    kept_[as_size(had[i])] = 0.0;
  }
  if (!(pressure_ > 0.0)) {
    radius_ = std::min(radius_, room(from));
  }
  radius_ = std::min(radius_ + growth_, options_.radius);
}

void BallContact::find_near(const BodyMotion& motion, const Vector3d& middle,
                            double reach) noexcept {
  for (const std::int32_t corner : corners_) {
    near_[as_size(corner)] =
        (motion.position(as_size(corner)) - middle).squaredNorm() < reach * reach;
  }
}

void BallContact::look_at(const BodyMotion& motion, std::int32_t number, const Vector3d& middle,
                          double reach) noexcept {
  if (looked_at_[as_size(number)] == tick_) {
    return;
  }
  looked_at_[as_size(number)] = tick_;
  Place place;
  place.sample = number;
  place.pressed = kept_[as_size(number)];
  place.before = place.after = where(motion, place);
  const double distance = (place.before - middle).norm();
  if (distance < reach || place.pressed > 0.0) {
    add(place, distance);
  }
}

/// If there is no room for another place, the farthest one gives way.
void BallContact::add(const Place& place, double distance) noexcept {
  std::size_t to = count_;
  if (count_ == kMostPlaces) {
    to = static_cast<std::size_t>(std::ranges::max_element(distance_) - distance_.begin());
    crowded_ = crowded_ || std::min(distance_[to], distance) < options_.radius;
    if (distance >= distance_[to]) {
      return;
    }
  } else {
    ++count_;
  }
  places_[to] = place;
  distance_[to] = distance;
}

/// Distance from the centre to the nearest place, if that is before it; 0 if the centre is behind.
double BallContact::room(const Vector3d& centre) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  double room = nearest;
  for (const Place& place : places()) {
    const Vector3d away = place.before - centre;
    if (away.squaredNorm() < nearest) {
      nearest = away.squaredNorm();
      room = away.dot(sample(place).outward) < 0.0 ? std::sqrt(nearest) : 0.0;
    }
  }
  return room;
}

void BallContact::press(BodyMotion& motion, const Vector3d& tool) noexcept {
  centre_before_ = centre_;
  for (Place& place : std::span(places_).first(count_)) {
    place.before = place.after;
    place.sum_before = place.sum;
  }
  press_again(motion, tool);
}

void BallContact::press_again(BodyMotion& motion, const Vector3d& tool) noexcept {
  for (Place& place : std::span(places_).first(count_)) {
    place.sum = place.sum_before;
  }
  const Vector3d guess = tool - force_ / options_.stiffness;
  centre_ = tool;
  force_.setZero();
  rub_on(motion);
  choose(motion, guess);
  find_compliance(motion);
  const bool rubs = options_.friction.static_friction > 0.0;
  for (int round = 0; round < (rubs ? kRounds : 1); ++round) {
    press_chosen(motion);
    rub(motion);
  }
  motion.finish_pushes();
  for (Place& place : std::span(places_).first(count_)) {
    place.after = where(motion, place);
  }
}

/// Friction goes on as on the step before, by the pressures of then.
void BallContact::rub_on(BodyMotion& motion) noexcept {
  for (std::size_t i = 0; i < count_ && pressure_ > 0.0; ++i) {
    if (places_[i].pressed > 0.0) {
      apply(motion, places_[i], places_[i].pressed / pressure_ * friction_);
    }
  }
}

/// Places that may be pressed on this step, and how they would lie without normal forces.
void BallContact::choose(const BodyMotion& motion, const Vector3d& centre) noexcept {
  problem_.free_gap.resize(static_cast<Eigen::Index>(count_));
  pressed_.resize(static_cast<Eigen::Index>(count_));
  Eigen::Index chosen = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Place& place = places_[i];
    const Vector3d p = where(motion, place);
    const Vector3d away = p - centre;
    place.normal = away.stableNormalized();
    const double gap = place.normal.dot(p - centre_) - radius_;
    if (gap < kNear * mesh_->spacing && away.dot(sample(place).outward) < 0.0) {
      problem_.free_gap[chosen] = gap;
      pressed_[chosen] = place.pressed;
      chosen_[static_cast<std::size_t>(chosen++)] = i;
    }
    place.pressed = 0.0;
  }
  problem_.free_gap.conservativeResize(chosen);
  pressed_.conservativeResize(chosen);
}

void BallContact::find_compliance(const BodyMotion& motion) noexcept {
  const Eigen::Index chosen = problem_.free_gap.size();
  problem_.compliance.resize(chosen, chosen);
  across_.resize(chosen, chosen);
  for (Eigen::Index i = 0; i < chosen; ++i) {
    const Place& p = chosen_place(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Place& q = chosen_place(j);
      across_(i, j) = across_(j, i) = together(motion, p, q) + 1.0 / options_.stiffness;
      problem_.compliance(i, j) = problem_.compliance(j, i) =
          across_(i, j) * p.normal.dot(q.normal);
    }
    problem_.compliance(i, i) *= 1.0 + kContactCompliance;
  }
}

void BallContact::press_chosen(BodyMotion& motion) noexcept {
  solved_ = deformable::press(problem_, pressed_) && solved_;
  pressure_ = pressed_.sum();
  for (Eigen::Index i = 0; i < pressed_.size(); ++i) {
    Place& place = chosen_place(i);
    const double more = pressed_[i] - place.pressed;
    place.pressed = pressed_[i];
    if (more != 0.0) {
      apply(motion, place, more * place.normal);
    }
  }
}

/// How far a force on one place moves another, over a step [m/N].
double BallContact::together(const BodyMotion& motion, const Place& a,
                             const Place& b) const noexcept {
  const SurfaceSamples::Sample& p = sample(a);
  const SurfaceSamples::Sample& q = sample(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (p.corners[i] == q.corners[j] || motion.spreads()) {
        sum += p.weight[static_cast<Eigen::Index>(i)] * q.weight[static_cast<Eigen::Index>(j)] *
               motion.mobility(as_size(p.corners[i]), as_size(q.corners[j]));
      }
    }
  }
  return sum;
}

/// Friction is changed so that the places, by their pressures, have not moved along the ball. What
/// that does to the gaps is left to the next round.
void BallContact::rub(BodyMotion& motion) noexcept {
  if (!(pressure_ > 0.0) || !(options_.friction.static_friction > 0.0)) {
    friction_.setZero();
    return;
  }
  const PressedPlaces::Vector share = pressed_ / pressure_;
  Vector3d normal = Vector3d::Zero();
  Vector3d moved = centre_before_ - centre_;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    normal += share[i] * chosen_place(i).normal;
    moved += share[i] * (where(motion, chosen_place(i)) - chosen_place(i).before);
  }
  normal.stableNormalize();
  const PressedPlaces::Vector gives = across_ * share;
  const Vector3d old = friction_;
  friction_ = across(old - moved / share.dot(gives), normal);
  const double most = options_.friction.static_friction * pressure_;
  slips_ = friction_.norm() > most;
  if (slips_) {
    friction_ *= options_.friction.dynamic_friction * pressure_ / friction_.norm();
  }
  const Vector3d more = friction_ - old;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    problem_.free_gap[i] += gives[i] * chosen_place(i).normal.dot(more);
    if (share[i] > 0.0) {
      apply(motion, chosen_place(i), share[i] * more);
    }
  }
}

void BallContact::apply(BodyMotion& motion, Place& place, const Vector3d& force) noexcept {
  const SurfaceSamples::Sample& s = sample(place);
  for (std::size_t k = 0; k < 3; ++k) {
    motion.push(as_size(s.corners[k]), s.weight[static_cast<Eigen::Index>(k)] * force);
  }
  place.sum += force;
  force_ += force;
  centre_ -= force / options_.stiffness;
}

double BallContact::depth(const Vector3d& tool) const noexcept {
  double depth = 0.0;
  for (const Place& place : places()) {
    if (!place.sum.isZero(0.0)) {
      depth = std::max(depth, radius_ - place.normal.dot(at_rest(place.sample) - tool));
    }
  }
  return depth;
}

}  // namespace haptrial::deformable
