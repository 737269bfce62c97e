#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/deformable/springs/spring_body.h"
#include "core/deformable/springs/spring_forces.h"

namespace haptrial::deformable {

struct MotionSettings {
  double step{1e-3};             // h > 0 [s]
  double damping{0.0};           // c >= 0, of every vertex [N·s/m]
  bool beyond_stability{false};  // take a step that is refused otherwise, to see what happens
  InstructionSet instructions{best_instruction_set()};
};

/// How fast free vertices move, and how fast that changes.
struct Activity {
  double max_speed{}, mean_speed{};                // [m/s]
  double max_acceleration{}, mean_acceleration{};  // [m/s²]
};

/// A body of springs in time, by Verlet's method with viscous damping, whose mean velocity over the
/// step it takes:
///
///     m (x₊ - 2 x + x₋) / h² = f(x) - c (x₊ - x₋) / 2h
///
/// Held vertices stay where they are put. One thread.
/// Source: Morris 2006, §5.4.1 ("integrated explicitly using Verlet integration").
class SpringMotion {
 public:
  /// @param held  vertices that do not move by themselves
  /// @throws InputError for a vertex that the body has not, a step or damping that is not allowed,
  /// or a step beyond stable_step() at rest.
  SpringMotion(const SpringBody& body, const MotionSettings& settings,
               std::span<const std::int32_t> held = {});

  /// Servo thread, all of these: no allocation, lock or throw (SpringMotionTest).
  void step() noexcept;
  void set_force(std::size_t vertex, const Eigen::Vector3d& force) noexcept;  // from outside
  void place(std::size_t vertex, const Eigen::Vector3d& position) noexcept;   // also a held one
  void set_velocity(std::size_t vertex, const Eigen::Vector3d& velocity) noexcept;  // of a free one
  /// Moves a vertex as if this force had acted over the last step, too: the effect of a contact
  /// that is looked for after the step. A vertex moves by mobility() for each newton.
  void push(std::size_t vertex, const Eigen::Vector3d& force) noexcept;
  double mobility(std::size_t vertex) const noexcept {  // [m/N]; 0 of a held one
    return settings_.step * kick_[vertex];
  }
  void stop() noexcept;  // at once
  /// Force of springs and from outside when the last step began, also on a held vertex [N].
  Eigen::Vector3d force(std::size_t vertex) const noexcept { return forces_[vertex]; }
  Eigen::Vector3d position(std::size_t vertex) const noexcept { return positions_[vertex]; }
  /// Half a step before position(), as Verlet's method has it.
  Eigen::Vector3d velocity(std::size_t vertex) const noexcept { return velocities_[vertex]; }
  /// Tetrahedra whose volume was not above 0 at the begin of the last step.
  std::size_t inverted() const noexcept { return inverted_; }
  /// Steps so far with such a tetrahedron.
  std::uint64_t inverted_steps() const noexcept { return inverted_steps_; }
  std::uint64_t steps() const noexcept { return steps_; }
  /// Speeds and accelerations of the last step.
  Activity activity() const noexcept;
  double time() const noexcept { return static_cast<double>(steps_) * settings_.step; }  // [s]

  std::size_t vertices() const noexcept { return masses_.size(); }
  std::vector<Eigen::Vector3d> positions() const;
  void copy_positions(std::span<Eigen::Vector3d> to) const noexcept;  // (vertices)
  bool held(std::size_t vertex) const noexcept { return kick_[vertex] == 0; }

  Eigen::Vector3d momentum() const;          // [kg·m/s]
  Eigen::Vector3d angular_momentum() const;  // about the origin [kg·m²/s]
  /// Kinetic energy at the time of the positions, with half a kick of the springs' forces [J].
  double kinetic_energy() const;

 private:
  MotionSettings settings_;
  SpringForces springs_;
  std::vector<double> masses_;
  std::vector<double> keep_, kick_;  // v₊ = keep v + kick f; both 0 where held
  PaddedPoints positions_, velocities_, forces_, external_;
  std::size_t inverted_{0};
  std::uint64_t inverted_steps_{0};
  std::uint64_t steps_{0};
};

}  // namespace haptrial::deformable
