#include "core/deformable/springs/spring_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

void check_settings(const SpringBody& body, const MotionSettings& settings,
                    std::span<const std::int32_t> held) {
  if (!std::isfinite(settings.step) || settings.step <= 0) {
    throw InputError(fmt::format("springs: the step is {} s; above 0 is allowed", settings.step));
  }
  if (!std::isfinite(settings.damping) || settings.damping < 0) {
    throw InputError(
        fmt::format("springs: the damping is {} N·s/m; at least 0 is allowed", settings.damping));
  }
  for (const std::int32_t vertex : held) {
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= body.rest.size()) {
      throw InputError(fmt::format("springs: the held vertex {} is not one of 0 to {}", vertex,
                                   body.rest.size() - 1));
    }
  }
  if (settings.beyond_stability) {
    return;
  }
  const double most = stable_step(body, held);
  if (settings.step > most) {
    throw InputError(
        fmt::format("springs: a step of {:.4g} s is unstable for this body; at most {:.4g} s is "
                    "allowed, or softer constants, or more mass",
                    settings.step, most));
  }
}

}  // namespace

SpringMotion::SpringMotion(const SpringBody& body, const MotionSettings& settings,
                           std::span<const std::int32_t> held)
    : SpringMotion(body, settings, held, SpringForces(body, settings.instructions)) {}

SpringMotion::SpringMotion(const SpringBody& body, const MotionSettings& settings,
                           std::span<const std::int32_t> held, SpringForces springs)
    : BodyMotion(body.masses, springs.points(), (check_settings(body, settings, held), held)),
      settings_(settings),
      springs_(std::move(springs)) {
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    const double drag = 0.5 * settings.damping * settings.step;
    keep_.push_back((masses_[v] - drag) / (masses_[v] + drag));
    kick_.push_back(settings.step / (masses_[v] + drag));
    positions_[v] = body.rest[v];
  }
  for (const std::int32_t vertex : held) {
    keep_[static_cast<std::size_t>(vertex)] = 0;
    kick_[static_cast<std::size_t>(vertex)] = 0;
  }
}

void SpringMotion::step() noexcept {
  std::memcpy(forces_.data(), external_.data(), 4 * sizeof(double) * external_.size());
  count_inverted(springs_.add(positions_, forces_));
  double* x = positions_.data();
  double* v = velocities_.data();
  const double* f = forces_.data();
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const double keep = keep_[i];
    const double kick = kick_[i];
    for (std::size_t axis = 4 * i; axis < 4 * i + 4; ++axis) {
      v[axis] = keep * v[axis] + kick * f[axis];
      x[axis] += settings_.step * v[axis];
    }
  }
  ++steps_;
}

void SpringMotion::push(std::size_t vertex, const Vector3d& force) noexcept {
  const Vector3d faster = kick_[vertex] * force;
  velocities_[vertex] += faster;
  positions_[vertex] += settings_.step * faster;
}

Activity SpringMotion::activity() const noexcept {
  Activity activity;
  std::size_t free = 0;
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    if (held(v)) {
      continue;
    }
    ++free;
    const Vector3d drag = settings_.damping * velocities_[v];
    const double speed = velocities_[v].norm();
    const double acceleration = (forces_[v] - drag).norm() / masses_[v];
    activity.max_speed = std::max(activity.max_speed, speed);
    activity.max_acceleration = std::max(activity.max_acceleration, acceleration);
    activity.mean_speed += speed;
    activity.mean_acceleration += acceleration;
  }
  if (free == 0) {
    return {};
  }
  activity.mean_speed /= static_cast<double>(free);
  activity.mean_acceleration /= static_cast<double>(free);
  // A maximum passes over what is not a number; a mean does not.
  if (!std::isfinite(activity.mean_speed)) {
    activity.max_speed = activity.mean_speed;
  }
  if (!std::isfinite(activity.mean_acceleration)) {
    activity.max_acceleration = activity.mean_acceleration;
  }
  return activity;
}

bool Activity::below(const Activity& limits) const noexcept {
  return max_speed < limits.max_speed && mean_speed < limits.mean_speed &&
         max_acceleration < limits.max_acceleration && mean_acceleration < limits.mean_acceleration;
}

double SpringMotion::kinetic_energy() const {
  PaddedPoints forces = external_;
  springs_.add(positions_, forces);
  double energy = 0;
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    if (held(v)) {
      continue;
    }
    const Vector3d after = keep_[v] * velocities_[v] + kick_[v] * forces[v];
    energy += 0.5 * masses_[v] * (0.5 * (velocities_[v] + after)).squaredNorm();
  }
  return energy;
}

std::vector<std::int32_t> held_vertices(const LoadCase& load) {
  std::vector<std::int32_t> held;
  for (const Hold& hold : load.holds) {
    held.push_back(hold.vertex);
  }
  return held;
}

void apply(const LoadCase& load, const SpringBody& body, SpringMotion& motion) {
  std::map<std::size_t, Vector3d> forces;
  for (const Hold& hold : load.holds) {
    const auto vertex = static_cast<std::size_t>(hold.vertex);
    motion.place(vertex, body.rest[vertex] + hold.displacement);
  }
  for (const NodalForce& nodal : load.forces) {
    auto [at, fresh] = forces.try_emplace(static_cast<std::size_t>(nodal.vertex), Vector3d::Zero());
    at->second += nodal.force;
  }
  for (const auto& [vertex, force] : forces) {
    motion.set_force(vertex, force);
  }
}

}  // namespace haptrial::deformable
