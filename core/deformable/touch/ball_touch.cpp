#include "core/deformable/touch/ball_touch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::deformable {

using contact::ContactState;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr int kMostRounds = 6;           // of places and forces on a tick
constexpr double kSettled = 1e-3;        // of the force from one round to the next
constexpr double kLeastForce = 1e-6;     // [N]
constexpr double kAhead = 0.03;          // of a cell: places that are that near may be pressed
constexpr double kOnSurface = 1e-3;      // of a cell: nearer the face's own normal is taken
constexpr double kSampled = 0.2;         // of the radius: how far samples are apart, about
constexpr double kOwnCompliance = 1e-6;  // added to each place's: two places may be one
constexpr double kInside = 1e-9;         // of a cell's volume: less is inside out

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

Vector3d weights_of(const Vector3d& p, const geometry::Corners& c) {
  const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double size = normal.squaredNorm();
  if (!(size > 0.0)) {
    return Vector3d::UnitX();
  }
  Vector3d w;
  w[1] = (p - c[0]).cross(c[2] - c[0]).dot(normal) / size;
  w[2] = (c[1] - c[0]).cross(p - c[0]).dot(normal) / size;
  w[1] = std::clamp(w[1], 0.0, 1.0);
  w[2] = std::clamp(w[2], 0.0, 1.0 - w[1]);
  w[0] = 1.0 - w[1] - w[2];
  return w;
}

/// Options with the radius of a ball that the body's cells can show.
TouchOptions felt_options(const Compliance& body, TouchOptions options) {
  check(options);
  options.radius = std::max(options.radius, smallest_ball(body.mesh()));
  return options;
}

int steps_of(const Compliance& body, const TouchOptions& options) {
  const double radius = felt_options(body, options).radius;
  return static_cast<int>(std::ceil(body.mesh().spacing / (kSampled * radius)));
}

}  // namespace

BallTouch::BallTouch(SharedCompliance body, const TouchOptions& options)
    : body_(std::move(body)),
      options_(felt_options(*body_, options)),
      samples_(body_->samples(steps_of(*body_, options))) {
  found_.resize(body_->faces().size());
  faces_.reserve(kMostFaces);
  near_.reserve(kMostNear);
  number_.assign(body_->touched(), -1);
  moved_.resize(kMostNear);
  moved_before_.resize(kMostNear);
  near_force_.resize(kMostNear);
  share_.resize(kMostNear);
  columns_.resize(kMostNear * kMostNear);
  column_at_.assign(kMostNear, 0);
  response_.resize(kMostNear * static_cast<std::size_t>(kMostPlaces));
  last_pressed_.assign(samples_->samples.size(), 0);
  pressed_in_.assign(samples_->samples.size(), 0);
  looked_at_.assign(samples_->samples.size(), 0);
  forces_.resize(kMostNear);
  loaded_.resize(kMostNear);
  deep_.resize(body_->places());
  deep_at_.assign(body_->places(), 0);
}

void BallTouch::start(const Vector3d& tool) noexcept {
  tick_ += 2;  // nothing was pressed on the tick before
  round_ += 2;
  begins_ = true;
  release(tool);
}

/// A ball that is deep in a body finds its places from those of the tick before. Without them its
/// first tick would find none, or some on another side.
void BallTouch::adopt(const BodyTouch& before, const Vector3d& tool) noexcept {
  start(tool);
  const auto* same = dynamic_cast<const BallTouch*>(&before);
  if (same == nullptr || same->tool_ != tool || same->options_.radius != options_.radius ||
      &same->body_->mesh() != &body_->mesh()) {
    return;
  }
  normal_force_ = same->normal_force_;
  friction_ = same->friction_;
  bristle_ = same->bristle_;
  farthest_ = same->farthest_;
  upright_ = same->upright_;
  contact_ = same->contact_;
  loaded_count_ = same->loaded_count_;
  std::copy_n(same->loaded_.begin(), loaded_count_, loaded_.begin());
  for (int c = 0; c < same->count_; ++c) {
    const std::int32_t sample = same->places_[static_cast<std::size_t>(c)].sample;
    if (sample >= 0 && same->last_pressed_[at(sample)] == same->tick_) {
      last_pressed_[at(sample)] = tick_;
    }
    if (sample >= 0 && same->pressed_in_[at(sample)] == same->round_) {
      pressed_in_[at(sample)] = round_;
    }
  }
}

void BallTouch::release(const Vector3d& tool) noexcept {
  loaded_count_ = force_count_ = 0;
  normal_force_.setZero();
  friction_.setZero();
  bristle_ = farthest_ = upright_ = 0.0;
  tool_ = tool;
  contact_ = {};
  contact_.proxy = tool;
}

const contact::Contact& BallTouch::tick(const Vector3d& tool, double period) noexcept {
  ++tick_;
  crowded_ = false;
  if (!tool.allFinite()) {
    contact_.force.setZero();
    force_count_ = 0;
    return contact_;
  }
  const Vector3d before = contact_.force;
  const double bent = options_.stiffness * (tool - tool_).norm();
  gather(tool, tool - normal_force_ / options_.stiffness);
  if (near_.empty() || !settle(tool)) {
    release(tool);
  } else {
    ++counts_.contact;
    counts_.crowded += crowded_ ? 1 : 0;
    rub(tool);
    keep_forces();
    note(tool);
    limit();
    tool_ = tool;
  }
  if (!std::exchange(begins_, false)) {
    bound_change(before, bent, kFastestAtRest * period, contact_);
  }
  return contact_;
}

/// Faces that the ball may reach, wherever they are moved to, and where their corners are now.
void BallTouch::gather(const Vector3d& tool, const Vector3d& centre) noexcept {
  for (const std::int32_t place : near_) {
    number_[at(place)] = -1;
  }
  near_.clear();
  faces_.clear();
  clear_ = 0.0;
  way_ = (tool - tool_).norm();
  const double reach = options_.radius + kAhead * body_->mesh().spacing + way_ + farthest_;
  int count = body_->surface().gather(centre, reach, found_);
  if (count > static_cast<int>(kMostFaces)) {
    std::nth_element(found_.begin(), found_.begin() + kMostFaces, found_.begin() + count,
                     [](const auto& a, const auto& b) {
                       return a.distance != b.distance ? a.distance < b.distance : a.slot < b.slot;
                     });
    count = static_cast<int>(kMostFaces);
    crowded_ = true;
  }
  for (int i = 0; i < count; ++i) {
    const std::int32_t face = body_->surface().triangle(found_[static_cast<std::size_t>(i)].slot);
    if (near_.size() + 3 > kMostNear) {
      crowded_ = true;
      break;
    }
    for (const std::int32_t corner : body_->faces()[at(face)]) {
      note_near(corner);
    }
    faces_.push_back(face);
  }
  for (std::size_t v = 0; v < near_.size(); ++v) {
    Vector3f u = Vector3f::Zero();
    for (std::size_t l = 0; l < loaded_count_; ++l) {
      u += body_->response(near_[v], loaded_[l].vertex, loaded_[l].force);
    }
    moved_[v] = u.cast<double>();
  }
}

void BallTouch::note_near(std::int32_t place) noexcept {
  if (number_[at(place)] < 0) {
    number_[at(place)] = static_cast<std::int32_t>(near_.size());
    near_.push_back(place);
  }
}

Vector3d BallTouch::now(std::int32_t near) const noexcept {
  return body_->rest(near_[at(near)]) + moved_[at(near)];
}

/// Places and forces follow from each other. @returns whether anything is pressed.
bool BallTouch::settle(const Vector3d& tool) noexcept {
  bool settled = false;
  for (int round = 0; round < kMostRounds && !settled; ++round) {
    find_places(tool - normal_force_ / options_.stiffness);
    if (count_ == 0) {
      return false;
    }
    respond();
    const Vector3d before = normal_force_;
    const bool solved = press_places(tool);
    settled =
        solved && (normal_force_ - before).norm() <= kSettled * normal_force_.norm() + kLeastForce;
  }
  contact_.settled = settled;
  counts_.unsettled += settled ? 0 : 1;
  return pressed_.size() > 0 && pressed_.maxCoeff() > 0.0;
}

/// Finds the sampled places; the nearest point of all faces if the centre is inside of the body.
void BallTouch::find_places(const Vector3d& centre) noexcept {
  count_ = 0;
  // A ball that was outside stays outside until it can have come to a face.
  const bool clear = clear_ > (centre - clear_at_).norm() + stirred_;
  if (clear || !take_nearest(centre)) {
    count_ = 0;
    take_samples(centre);
  }
}

/// @returns whether the centre is inside of the body, by the mean of the normals of the faces that
/// are nearest, or on its surface.
bool BallTouch::take_nearest(const Vector3d& centre) noexcept {
  const double same = 1e-6 * body_->mesh().spacing;
  Place best;
  Vector3d outward = Vector3d::Zero();
  for (const std::int32_t face : faces_) {
    Place place;
    geometry::Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      place.near[k] = number_[at(body_->faces()[at(face)][k])];
      corners[k] = now(place.near[k]);
    }
    place.at = geometry::closest_on_triangle(centre, corners[0], corners[1], corners[2]).point;
    place.distance = (centre - place.at).norm();
    const Vector3d normal =
        (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    if (count_ > 0 && (place.at - best.at).norm() <= same) {
      outward += normal;
    } else if (count_ == 0 || place.distance < best.distance) {
      best = place;
      best.weight = weights_of(place.at, corners);
      outward = normal;
      count_ = 1;
    }
  }
  const Vector3d away = centre - best.at;
  const bool on_surface = best.distance < kOnSurface * body_->mesh().spacing;
  const bool inside = on_surface || away.dot(outward) < 0.0;
  best.normal = on_surface ? Vector3d(-outward.stableNormalized())
                           : Vector3d((inside ? away : Vector3d(-away)) / best.distance);
  places_[0] = best;
  clear_ = inside ? 0.0 : best.distance;
  clear_at_ = centre;
  stirred_ = 0.0;
  return inside;
}

void BallTouch::take_samples(const Vector3d& centre) noexcept {
  const double far = options_.radius + kAhead * body_->mesh().spacing + way_;
  double most = 0.0;
  for (std::size_t v = 0; v < near_.size(); ++v) {
    most = std::max(most, moved_[v].squaredNorm());
  }
  const double reach = far + std::sqrt(most);  // of what is at rest
  ++round_;
  for (const std::int32_t face : faces_) {
    for (const std::int32_t number : samples_->on(face)) {
      if (looked_at_[at(number)] == round_) {
        continue;
      }
      looked_at_[at(number)] = round_;
      const SurfaceSamples::Sample& sample = samples_->samples[at(number)];
      const bool was_pressed = last_pressed_[at(number)] + 1 >= tick_;
      if (!was_pressed && (sample.rest - centre).squaredNorm() > reach * reach) {
        continue;
      }
      Place place;
      place.sample = number;
      place.weight = sample.weight;
      place.at.setZero();
      for (std::size_t k = 0; k < 3; ++k) {
        place.near[k] = number_[at(sample.corners[k])];
        place.at += sample.weight[static_cast<Eigen::Index>(k)] * now(place.near[k]);
      }
      const Vector3d towards = place.at - centre;
      place.distance = towards.norm();
      if ((was_pressed || place.distance < far) && towards.dot(sample.outward) < 0.0) {
        place.normal = towards / place.distance;
        add_place(place);
      }
    }
  }
}

/// If there is no room for another place, the farthest one gives way; that is told if the ball
/// touches it.
void BallTouch::add_place(const Place& place) noexcept {
  if (count_ < kMostPlaces) {
    places_[static_cast<std::size_t>(count_++)] = place;
    return;
  }
  const auto farthest =
      std::max_element(places_.begin(), places_.end(),
                       [](const Place& a, const Place& b) { return a.distance < b.distance; });
  const double left_out = std::max(place.distance, farthest->distance);
  crowded_ = crowded_ || left_out < options_.radius + kOnSurface * body_->mesh().spacing;
  if (place.distance < farthest->distance) {
    *farthest = place;
  }
}

/// Response of every near vertex to a force on a near vertex; fetched once a tick.
const Compliance::Block* BallTouch::column(std::int32_t near) noexcept {
  Compliance::Block* column = &columns_[at(near) * kMostNear];
  if (column_at_[at(near)] != tick_) {
    column_at_[at(near)] = tick_;
    for (std::size_t v = 0; v < near_.size(); ++v) {
      column[v] = body_->block(near_[v], near_[at(near)]);
    }
  }
  return column;
}

/// Computes the response of every near vertex to a force of 1 N along each place's normal.
void BallTouch::respond() noexcept {
  for (int c = 0; c < count_; ++c) {
    const Place& place = places_[static_cast<std::size_t>(c)];
    Vector3f* to = &response_[static_cast<std::size_t>(c) * kMostNear];
    std::fill_n(to, near_.size(), Vector3f::Zero());
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(place.weight[static_cast<Eigen::Index>(k)] > 0.0)) {
        continue;
      }
      const Vector3f force =
          (place.weight[static_cast<Eigen::Index>(k)] * place.normal).cast<float>();
      const Compliance::Block* blocks = column(place.near[k]);
      for (std::size_t v = 0; v < near_.size(); ++v) {
        to[v] += Compliance::response(blocks[v], force);
      }
    }
  }
}

/// @returns whether the forces were found.
bool BallTouch::press_places(const Vector3d& tool) noexcept {
  problem_.compliance.resize(count_, count_);
  problem_.free_gap.resize(count_);
  pressed_.resize(count_);
  const auto at_place = [&](int place, int other) {
    const Place& p = places_[static_cast<std::size_t>(place)];
    const Vector3f* u = &response_[static_cast<std::size_t>(other) * kMostNear];
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      sum += p.weight[static_cast<Eigen::Index>(k)] * u[at(p.near[k])].cast<double>();
    }
    return p.normal.dot(sum);
  };
  for (int i = 0; i < count_; ++i) {
    const Place& p = places_[static_cast<std::size_t>(i)];
    Vector3d rest = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      rest += p.weight[static_cast<Eigen::Index>(k)] * body_->rest(near_[at(p.near[k])]);
    }
    problem_.free_gap[i] = p.normal.dot(rest - tool) - options_.radius;
    // The search for what is pressed begins at what was pressed in the round before.
    const bool was_pressed = p.sample >= 0 && pressed_in_[at(p.sample)] + 1 >= round_;
    pressed_[i] = was_pressed ? 1.0 : 0.0;
    for (int j = 0; j <= i; ++j) {
      const Place& q = places_[static_cast<std::size_t>(j)];
      const double body = 0.5 * (at_place(i, j) + at_place(j, i));
      const double both = body + p.normal.dot(q.normal) / options_.stiffness;
      problem_.compliance(i, j) = problem_.compliance(j, i) =
          both * (i == j ? 1.0 + kOwnCompliance : 1.0);
    }
  }
  const bool solved = press(problem_, pressed_);
  normal_force_.setZero();
  std::swap(moved_, moved_before_);
  std::fill_n(moved_.begin(), near_.size(), Vector3d::Zero());
  for (int c = 0; c < count_; ++c) {
    if (!(pressed_[c] > 0.0)) {
      continue;
    }
    const Place& place = places_[static_cast<std::size_t>(c)];
    normal_force_ += pressed_[c] * place.normal;
    if (place.sample >= 0) {
      last_pressed_[at(place.sample)] = tick_;
      pressed_in_[at(place.sample)] = round_;
    }
    const Vector3f* u = &response_[static_cast<std::size_t>(c) * kMostNear];
    for (std::size_t v = 0; v < near_.size(); ++v) {
      moved_[v] += pressed_[c] * u[v].cast<double>();
    }
  }
  double most = 0.0;
  for (std::size_t v = 0; v < near_.size(); ++v) {
    most = std::max(most, (moved_[v] - moved_before_[v]).squaredNorm());
  }
  stirred_ += std::sqrt(most);
  return solved;
}

/// The bristle: it is bent by the tool's way along the surface, and slips as Coulomb's law says.
void BallTouch::rub(const Vector3d& tool) noexcept {
  std::fill_n(near_force_.begin(), near_.size(), Vector3d::Zero());
  std::fill_n(share_.begin(), near_.size(), 0.0);
  const double pressure = pressed_.sum();
  for (int c = 0; c < count_; ++c) {
    const Place& place = places_[static_cast<std::size_t>(c)];
    for (std::size_t k = 0; k < 3; ++k) {
      const double part = place.weight[static_cast<Eigen::Index>(k)] * pressed_[c];
      near_force_[at(place.near[k])] += part * place.normal;
      share_[at(place.near[k])] += part / pressure;
    }
  }
  contact_.state = ContactState::kSlip;
  if (!(options_.friction.static_friction > 0.0)) {
    return;
  }
  const Vector3d normal = normal_force_.stableNormalized();
  const double now = across(normal);
  const double kept = bristle_ > 0.0 ? std::min(1.0, bristle_ / now) : 0.0;
  bristle_ = now;
  const Vector3d way = (tool - tool_) - (tool - tool_).dot(normal) * normal;
  friction_ = kept * (friction_ - friction_.dot(normal) * normal) + way / now;
  const double most = options_.friction.static_friction * pressure;
  if (friction_.norm() > most) {
    friction_ *= options_.friction.dynamic_friction * pressure / friction_.norm();
  } else {
    contact_.state = ContactState::kStick;
  }
}

/// How the pressed places and the spring give way across the normal, on the mean of directions.
double BallTouch::across(const Vector3d& normal) noexcept {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t b = 0; b < near_.size(); ++b) {
    if (!(share_[b] > 0.0)) {
      continue;
    }
    const Compliance::Block* blocks = column(static_cast<std::int32_t>(b));
    for (std::size_t a = 0; a < near_.size(); ++a) {
      if (share_[a] > 0.0) {
        using Columns = Eigen::Map<const Eigen::Matrix<float, 4, 3>, Eigen::Aligned16>;
        const auto both = static_cast<float>(share_[a] * share_[b]);
        sum += (both * Columns(blocks[a].data()).topRows<3>()).cast<double>();
      }
    }
  }
  return 0.5 * (sum.trace() - normal.dot(sum * normal)) + 1.0 / options_.stiffness;
}

void BallTouch::keep_forces() noexcept {
  loaded_count_ = force_count_ = 0;
  farthest_ = 0.0;
  for (std::size_t v = 0; v < near_.size(); ++v) {
    farthest_ = std::max(farthest_, moved_[v].norm());
    if (share_[v] > 0.0) {
      loaded_[loaded_count_++] = {near_[v], near_force_[v].cast<float>()};
      forces_[force_count_++] = {near_[v], (near_force_[v] + share_[v] * friction_).cast<float>()};
    }
  }
}

void BallTouch::note(const Vector3d& tool) noexcept {
  contact_.proxy = tool - normal_force_ / options_.stiffness;
  contact_.normal = -normal_force_.stableNormalized();
  contact_.depth = std::max(0.0, -problem_.free_gap.minCoeff());
  contact_.force = -(normal_force_ + friction_);
}

/// A force that would turn a tetrahedron inside out is cut to what it was before.
void BallTouch::limit() noexcept {
  const double size = contact_.force.norm();
  if (!inverts()) {
    upright_ = size;
  } else {
    ++counts_.inverted;
    const double part = size > upright_ ? upright_ / size : 1.0;
    contact_.force *= part;
    for (std::size_t i = 0; i < force_count_; ++i) {
      forces_[i].force *= static_cast<float>(part);
    }
  }
  for (std::size_t i = 0; i < force_count_; ++i) {
    forces_[i].vertex = body_->vertex(forces_[i].vertex);
  }
}

/// Whether one of the tetrahedra at the pressed vertices does not keep its volume above zero.
bool BallTouch::inverts() noexcept {
  const auto moved = [&](std::int32_t place) {
    if (deep_at_[at(place)] != tick_) {
      deep_at_[at(place)] = tick_;
      Vector3f u = Vector3f::Zero();
      for (std::size_t i = 0; i < force_count_; ++i) {
        u += body_->response(place, forces_[i].vertex, forces_[i].force);
      }
      deep_[at(place)] = u;
    }
    return Vector3d(body_->rest(place) + deep_[at(place)].cast<double>());
  };
  const double least = kInside * std::pow(body_->mesh().spacing, 3);
  for (std::size_t i = 0; i < force_count_; ++i) {
    for (const std::int32_t number : body_->tets_at(forces_[i].vertex)) {
      const geometry::Tetrahedron& t = body_->outer_tets()[at(number)];
      const Vector3d a = moved(t[0]);
      if (!((moved(t[1]) - a).dot((moved(t[2]) - a).cross(moved(t[3]) - a)) > least)) {
        return true;
      }
    }
  }
  return false;
}

double smallest_ball(const HapticMesh& mesh) { return 0.5 * mesh.spacing; }

}  // namespace haptrial::deformable
