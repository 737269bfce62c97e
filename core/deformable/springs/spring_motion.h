#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/deformable/body/body_motion.h"
#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_body.h"
#include "core/deformable/springs/spring_forces.h"

namespace haptrial::deformable {

struct MotionSettings {
  double step{1e-3};             // h > 0 [s]
  double damping{0.0};           // c >= 0, of every vertex [N·s/m]
  bool beyond_stability{false};  // take a step that is refused otherwise, to see what happens
  InstructionSet instructions{best_instruction_set()};
};

/// How fast free vertices move, and how fast that changes. A body rests when all four stay below
/// limits for some time. Source: Morris 2006, §5.3.3.
struct Activity {
  double max_speed{}, mean_speed{};                // [m/s]
  double max_acceleration{}, mean_acceleration{};  // [m/s²]

  bool below(const Activity& limits) const noexcept;
};

/// A body of springs in time, by Verlet's method with viscous damping, whose mean velocity over the
/// step it takes:
///
///     m (x₊ - 2 x + x₋) / h² = f(x) - c (x₊ - x₋) / 2h
///
/// velocity() is half a step before position(), as that method has it.
/// Source: Morris 2006, §5.4.1 ("integrated explicitly using Verlet integration").
class SpringMotion final : public BodyMotion {
 public:
  /// @param held  vertices that do not move by themselves
  /// @throws InputError for a vertex that the body has not, a step or damping that is not allowed,
  /// or a step beyond stable_step() at rest.
  SpringMotion(const SpringBody& body, const MotionSettings& settings,
               std::span<const std::int32_t> held = {});

  // Servo thread, all of these: no allocation, lock or throw (SpringMotionTest).

  void step() noexcept override;
  bool refine() noexcept override { return false; }
  void push(std::size_t vertex, const Eigen::Vector3d& force) noexcept override;
  void finish_pushes() noexcept override {}
  double mobility(std::size_t vertex, std::size_t pushed) const noexcept override {
    return vertex == pushed ? settings_.step * kick_[vertex] : 0.0;
  }
  bool spreads() const noexcept override { return false; }

  std::uint64_t steps() const noexcept { return steps_; }
  /// Speeds and accelerations of the last step; not a number if one is not.
  Activity activity() const noexcept;
  double time() const noexcept { return static_cast<double>(steps_) * settings_.step; }  // [s]

  /// Kinetic energy at the time of the positions, with half a kick of the springs' forces [J].
  double kinetic_energy() const;

 private:
  SpringMotion(const SpringBody& body, const MotionSettings& settings,
               std::span<const std::int32_t> held, SpringForces springs);

  MotionSettings settings_;
  SpringForces springs_;
  std::vector<double> keep_, kick_;  // v₊ = keep v + kick f; both 0 where held
  std::uint64_t steps_{0};
};

/// The vertices that a load holds.
std::vector<std::int32_t> held_vertices(const LoadCase& load);

/// Moves held vertices to their places and sets the forces, several on a vertex summed.
/// The motion must hold held_vertices(load).
void apply(const LoadCase& load, const SpringBody& body, SpringMotion& motion);

}  // namespace haptrial::deformable
