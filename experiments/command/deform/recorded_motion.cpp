#include "experiments/command/deform/recorded_motion.h"

#include <fmt/format.h>

#include <cmath>

namespace haptrial::experiments {
namespace {

using deformable::MotionProblem;
using deformable::Vectors;
using Eigen::Vector3d;

/// Masses, holds and forces of a load; the elastic forces are the caller's.
MotionProblem problem_of(std::span<const double> masses, const deformable::LoadCase& load) {
  MotionProblem problem;
  problem.masses.assign(masses.begin(), masses.end());
  problem.held = deformable::held_flags(masses.size(), load.holds);
  problem.start.assign(masses.size(), Vector3d::Zero());
  problem.load = problem.start;
  for (const auto& hold : load.holds) {
    problem.start[static_cast<std::size_t>(hold.vertex)] = hold.displacement;
  }
  for (const auto& nodal : load.forces) {
    problem.load[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
  }
  return problem;
}

/// Springs as they move in an experiment: the same drag on every vertex (moving_body.h).
std::vector<double> even_drag(const std::vector<double>& masses, double damping) {
  double mean = 0.0;
  for (const double mass : masses) {
    mean += mass / static_cast<double>(masses.size());
  }
  return std::vector<double>(masses.size(), damping * mean);
}

SpringsInMotion fitted(const deformable::SpringBody& springs, const deformable::LoadCase& load,
                       const RecordedMotion& motion, const RecordedMotionOptions& options,
                       const deformable::MotionAccuracy& accuracy) {
  constexpr double kLeast = 0.1, kMost = 1000.0;  // [1/s]
  MotionProblem problem = problem_of(springs.masses, load);
  problem.elastic = [&](const Vectors& u, Vectors& force) {
    std::vector<Vector3d> places = springs.rest;
    for (std::size_t v = 0; v < places.size(); ++v) {
      places[v] += u[v];
    }
    force = deformable::spring_forces(springs, places);
    return true;
  };
  const auto motion_at = [&](double damping) {
    problem.drag = even_drag(springs.masses, damping);
    return reference_motion(problem, motion.times, accuracy, [](double) { check_interrupt(); });
  };
  SpringsInMotion found;
  found.damping = deformable::fitted_damping(motion.displacement, kLeast, kMost, motion_at);
  found.distance = deformable::motion_distance(motion_at(found.damping), motion.displacement);
  found.same = deformable::motion_distance(motion_at(options.damping), motion.displacement);
  return found;
}

}  // namespace

RecordedMotion recorded_motion(const deformable::ElasticBody& elastic,
                               const deformable::LoadCase& load,
                               const deformable::SpringBody* springs,
                               const RecordedMotionOptions& options) {
  RecordedMotion motion;
  for (int i = 1; i <= options.frames; ++i) {
    motion.times.push_back(options.seconds * i / options.frames);
  }
  MotionProblem problem = problem_of(elastic.masses(), load);
  for (const double mass : problem.masses) {
    problem.drag.push_back(options.damping * mass);
  }
  problem.elastic = [&](const Vectors& u, Vectors& force) {
    return std::isfinite(elastic.forces(u, force));
  };
  constexpr double kTold = 1e-3;  // of a displacement of a millimetre
  const deformable::MotionAccuracy accuracy{options.tolerance, kTold};
  motion.displacement =
      reference_motion(problem, motion.times, accuracy, [](double) { check_interrupt(); });
  const std::vector<Vectors> rest(motion.times.size(),
                                  Vectors(problem.masses.size(), Vector3d::Zero()));
  motion.moved = deformable::motion_distance(motion.displacement, rest);
  if (springs != nullptr) {
    motion.springs = fitted(*springs, load, motion, options, accuracy);
  }
  return motion;
}

std::string motion_csv(const RecordedMotion& motion) {
  std::string text = "time_s,vertex,ux_m,uy_m,uz_m\n";
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    const Vectors& u = motion.displacement[i];
    for (std::size_t v = 0; v < u.size(); ++v) {
      fmt::format_to(std::back_inserter(text), "{:.9g},{},{:.9g},{:.9g},{:.9g}\n", motion.times[i],
                     v, u[v].x(), u[v].y(), u[v].z());
    }
  }
  return text;
}

}  // namespace haptrial::experiments
