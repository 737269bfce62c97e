#include "core/deformable/touch/local_contact.h"

#include <algorithm>

namespace haptrial::deformable {

using Eigen::Index;
using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr int kLocalRounds = 2;            // of places and forces on a tick
constexpr double kLocalAhead = 0.2;        // of the radius: what is that near may be pressed
constexpr double kLocalCompliance = 1e-6;  // added to each place's: two places may be one

Vector3d without(const Vector3d& v, const Vector3d& n) { return v - v.dot(n) * n; }

}  // namespace

void LocalContact::forget() noexcept {
  for (Vector3d& moved : moved_) {
    moved.setZero();
  }
  was_pressed_.fill(false);
  pressed_.resize(0);
  pressure_ = depth_ = 0.0;
  for (Vector3d* each : {&friction_, &begun_, &force_, &normal_}) {
    each->setZero();
  }
  slips_ = false;
  solved_ = true;
}

void LocalContact::look_at(const LocalSurface& surface) noexcept {
  for (std::size_t i = 0; i < surface.count; ++i) {
    const LocalSurface::Place& place = surface.places[i];
    moved_[i] = place.at - place.free;
    was_pressed_[i] = place.pressed;
  }
  if (surface.touches) {
    begun_ = surface.friction;
    bent_from_ = surface.tool;
  }
}

bool LocalContact::tick(const LocalSurface& surface, const Vector3d& tool, double age) noexcept {
  if (!(pressure_ > 0.0) && !surface.touches) {
    begun_.setZero();
    bent_from_ = tool;
  }
  centre_ = tool - force_ / options_.stiffness;
  for (int round = 0; round < kLocalRounds; ++round) {
    choose(surface, age);
    press(surface, tool, age);
    rub(surface, tool);
    force_ = friction_;
    for (Index i = 0; i < pressed_.size(); ++i) {
      force_ += pressed_[i] * chosen(i).normal;
    }
    centre_ = tool - force_ / options_.stiffness;
    respond(surface);
  }
  find_depth(surface, tool);
  return pressure_ > 0.0;
}

/// Places before the ball that may be pressed, as they lie by the last forces.
void LocalContact::choose(const LocalSurface& surface, double age) noexcept {
  pressed_.resize(static_cast<Index>(LocalSurface::kMost));
  Index count = 0;
  for (std::size_t i = 0; i < surface.count; ++i) {
    const LocalSurface::Place& place = surface.places[i];
    const Vector3d away = place.free + age * place.drift + moved_[i] - centre_;
    const bool near = away.norm() < (1.0 + kLocalAhead) * surface.radius;
    if ((near || was_pressed_[i]) && away.dot(place.sample.outward) < 0.0) {
      chosen_[static_cast<std::size_t>(count)] = {i, away.stableNormalized()};
      pressed_[count++] = was_pressed_[i] ? 1.0 : 0.0;
    }
  }
  pressed_.conservativeResize(count);
}

void LocalContact::press(const LocalSurface& surface, const Vector3d& tool, double age) noexcept {
  const Index count = pressed_.size();
  const double spring = 1.0 / options_.stiffness;
  problem_.free_gap.resize(count);
  problem_.compliance.resize(count, count);
  const Vector3d centre = tool - spring * friction_;
  for (Index i = 0; i < count; ++i) {
    const std::size_t place = chosen(i).place;
    const Vector3d& n = chosen(i).normal;
    const Vector3f normal = n.cast<float>();
    const Vector3d at = surface.places[place].free + age * surface.places[place].drift;
    for (Index j = 0; j <= i; ++j) {
      const Vector3f other = chosen(j).normal.cast<float>();
      const Vector3f moved = surface.give(place, chosen(j).place) * other;
      problem_.compliance(i, j) = problem_.compliance(j, i) =
          static_cast<double>(normal.dot(moved)) + spring * n.dot(chosen(j).normal);
    }
    problem_.free_gap[i] = n.dot(at - centre) - surface.radius;
    problem_.compliance(i, i) *= 1.0 + kLocalCompliance;
  }
  solved_ = deformable::press(problem_, pressed_);
  pressure_ = pressed_.sum();
}

/// Friction as the tool's way since it was known bends it.
void LocalContact::rub(const LocalSurface& surface, const Vector3d& tool) noexcept {
  friction_.setZero();
  slips_ = false;
  if (!(pressure_ > 0.0)) {
    return;
  }
  normal_.setZero();
  for (Index i = 0; i < pressed_.size(); ++i) {
    normal_ += pressed_[i] * chosen(i).normal;
  }
  normal_.stableNormalize();
  const contact::Friction& law = options_.friction;
  if (!(law.static_friction > 0.0)) {
    return;
  }
  const double stiffness = 1.0 / (1.0 / options_.stiffness + across(surface));
  friction_ = without(begun_ + stiffness * (tool - bent_from_), normal_);
  const bool slipped = surface.touches && surface.slips;
  const double most = (slipped ? law.dynamic_friction : law.static_friction) * pressure_;
  slips_ = friction_.norm() > most;
  if (slips_) {
    friction_ *= law.dynamic_friction * pressure_ / friction_.norm();
  }
}

/// How the places give way across the normal to a force that they share as their pressures [m/N].
double LocalContact::across(const LocalSurface& surface) const noexcept {
  Matrix3f all = Matrix3f::Zero();
  for (Index i = 0; i < pressed_.size(); ++i) {
    for (Index j = 0; j < pressed_.size() && pressed_[i] > 0.0; ++j) {
      const auto share = static_cast<float>(pressed_[i] * pressed_[j] / (pressure_ * pressure_));
      all += share * surface.give(chosen(i).place, chosen(j).place);
    }
  }
  const Vector3f n = normal_.cast<float>();
  return 0.5 * static_cast<double>(all.trace() - n.dot(all * n));
}

/// How the normal forces move all places.
void LocalContact::respond(const LocalSurface& surface) noexcept {
  was_pressed_.fill(false);
  for (std::size_t p = 0; p < surface.count; ++p) {
    Vector3f moved = Vector3f::Zero();
    for (Index i = 0; i < pressed_.size(); ++i) {
      if (pressed_[i] > 0.0) {
        moved += surface.give(p, chosen(i).place) * (pressed_[i] * chosen(i).normal).cast<float>();
      }
    }
    moved_[p] = moved.cast<double>();
  }
  for (Index i = 0; i < pressed_.size(); ++i) {
    was_pressed_[chosen(i).place] = pressed_[i] > 0.0;
  }
}

void LocalContact::find_depth(const LocalSurface& surface, const Vector3d& tool) noexcept {
  depth_ = 0.0;
  for (Index i = 0; i < pressed_.size(); ++i) {
    if (pressed_[i] > 0.0) {
      const Vector3d& rest = surface.places[chosen(i).place].rest;
      depth_ = std::max(depth_, surface.radius - chosen(i).normal.dot(rest - tool));
    }
  }
}

std::size_t LocalContact::forces(const LocalSurface& surface,
                                 std::span<VertexForce> to) const noexcept {
  std::size_t count = 0;
  for (Index i = 0; i < pressed_.size(); ++i) {
    if (!(pressed_[i] > 0.0)) {
      continue;
    }
    const SurfaceSamples::Sample& sample = surface.places[chosen(i).place].sample;
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = sample.weight[static_cast<Index>(k)];
      if (weight > 0.0) {
        to[count++] = {sample.corners[k], (weight * force_on(i)).cast<float>()};
      }
    }
  }
  return count;
}

}  // namespace haptrial::deformable
