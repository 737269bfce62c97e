#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/contact/proxy.h"
#include "core/contact/renderer.h"

namespace haptrial::deformable {

/// The tool that a body is touched by: a ball on a spring.
struct TouchOptions {
  double radius{0.005};      // 0: a point [m]
  double stiffness{5000.0};  // k > 0 of the spring between tool and ball [N/m]
  contact::Friction friction{};
};

/// @throws std::invalid_argument naming the option that breaks its bound.
void check(const TouchOptions& options);

/// The fastest change of a force that the hand does not make [N/s]. A body that moves by itself at
/// 0.1 m/s bends the usual spring as fast as the first. The second is of a body at rest, whose
/// contact may be lost, or found at another place.
inline constexpr double kFastestOfMoving = 500.0;
inline constexpr double kFastestAtRest = 100.0;

/// Limits the change of a force in a tick to what the hand makes by bending the ball's spring, and
/// what the body makes by itself. A change beyond that comes from steps that fail. A force that is
/// lost goes by as much, as if the contact went on.
/// @param before  a tick ago [N]  @param bent  by the hand since then >= 0 [N]
/// @param by_itself  of the body since then >= 0 [N]
void bound_change(const Eigen::Vector3d& before, double bent, double by_itself,
                  contact::Contact& contact) noexcept;

/// A force on one vertex of a body.
struct VertexForce {
  std::int32_t vertex{};                           // of the HapticMesh
  Eigen::Vector3f force{Eigen::Vector3f::Zero()};  // [N]
};

/// Counts of irregularities since the body was made, in ticks.
struct TouchCounts {
  std::uint64_t contact{};      // in contact
  std::uint64_t inverted{};     // a tetrahedron would be inside out: the force stays below that
  std::uint64_t unsettled{};    // the places of contact were not found to rounding
  std::uint64_t crowded{};      // more places than fit: the deepest were taken
  std::uint64_t limited{};      // the force was cut, or it might have given out energy
  std::uint64_t flown_apart{};  // the steps were too long for the deformed body: put to rest
  std::uint64_t late{};         // a body of its own rate was waited for

  bool operator==(const TouchCounts&) const = default;
};

/// A body that gives way to a tool, in the body's frame.
///
/// What is felt is what the body gets: the force on the tool is minus the sum of forces().
class BodyTouch {
 public:
  virtual ~BodyTouch() = default;

  // Servo thread, all of the following: no allocation, lock, I/O or throw.

  /// Puts the tool to a point, and the body to rest.
  virtual void start(const Eigen::Vector3d& tool) noexcept = 0;
  /// Contact with the same body before goes on; any other body begins at rest.
  virtual void adopt(const BodyTouch&, const Eigen::Vector3d& tool) noexcept { start(tool); }
  /// One tick. @param tool  [m]; not finite: zero force  @param period  > 0 [s]
  virtual const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept = 0;
  /// Forces on the body on the last tick.
  virtual std::span<const VertexForce> forces() const noexcept = 0;
  virtual const TouchCounts& counts() const noexcept = 0;
};

}  // namespace haptrial::deformable
