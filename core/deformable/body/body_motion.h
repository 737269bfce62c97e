#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/padded_points.h"

namespace haptrial::deformable {

/// A body in time, of whatever it is made: where its vertices are and how fast they move. Held
/// vertices stay where they are put. One thread.
class BodyMotion {
 public:
  virtual ~BodyMotion() = default;

  // Servo thread, all of the following but those that return a vector: no allocation, lock or
  // throw.

  virtual void step() noexcept = 0;
  /// Makes another round of the last step, better than the one before and without its pushes.
  /// @returns false, leaving the body alone, once the step is done.
  virtual bool refine() noexcept = 0;
  /// Moves the body as if this force had acted on a vertex over the last step, too: the effect of a
  /// contact that is looked for after the step. What can be pushed, too, has moved at once.
  virtual void push(std::size_t vertex, const Eigen::Vector3d& force) noexcept = 0;
  /// Moves the rest of the body after the pushes of a step.
  virtual void finish_pushes() noexcept = 0;
  /// How far a push on one vertex moves another, along the push [m/N]; 0 if one is held.
  virtual double mobility(std::size_t vertex, std::size_t pushed) const noexcept = 0;
  /// Whether a push moves other vertices, too.
  virtual bool spreads() const noexcept = 0;

  void set_force(std::size_t vertex, const Eigen::Vector3d& force) noexcept {  // from outside [N]
    external_[vertex] = force;
  }
  void place(std::size_t vertex, const Eigen::Vector3d& position) noexcept {  // also a held one
    positions_[vertex] = position;
  }
  void set_velocity(std::size_t vertex, const Eigen::Vector3d& velocity) noexcept;  // of a free one
  void stop() noexcept;                                                             // at once
  /// Goes on from where a motion of the same body is.
  void adopt(const BodyMotion& before) noexcept;

  Eigen::Vector3d position(std::size_t vertex) const noexcept { return positions_[vertex]; }
  Eigen::Vector3d velocity(std::size_t vertex) const noexcept { return velocities_[vertex]; }
  /// Force of the material and from outside as the last step computed it, also on a held vertex
  /// [N].
  Eigen::Vector3d force(std::size_t vertex) const noexcept { return forces_[vertex]; }
  bool held(std::size_t vertex) const noexcept { return held_[vertex] != 0; }
  std::size_t vertices() const noexcept { return masses_.size(); }
  /// Tetrahedra whose volume was not above 0 in the last step.
  std::size_t inverted() const noexcept { return inverted_; }
  /// Steps so far with such a tetrahedron.
  std::uint64_t inverted_steps() const noexcept { return inverted_steps_; }

  std::vector<Eigen::Vector3d> positions() const;
  void copy_positions(std::span<Eigen::Vector3d> to) const noexcept;  // (vertices)
  Eigen::Vector3d momentum() const;                                   // [kg·m/s]
  Eigen::Vector3d angular_momentum() const;  // about the origin [kg·m²/s]

 protected:
  /// @param points  rest, and behind them whatever else a kernel reads
  BodyMotion(std::vector<double> masses, PaddedPoints points, std::span<const std::int32_t> held);

  void count_inverted(std::size_t tetrahedra) noexcept {
    inverted_ = tetrahedra;
    inverted_steps_ += tetrahedra > 0 ? 1 : 0;
  }

  std::vector<double> masses_;
  std::vector<std::uint8_t> held_;
  PaddedPoints positions_, velocities_, forces_, external_;

 private:
  std::size_t inverted_{0};
  std::uint64_t inverted_steps_{0};
};

}  // namespace haptrial::deformable
