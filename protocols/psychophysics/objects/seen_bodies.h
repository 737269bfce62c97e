#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/moving_touch.h"
#include "core/geometry/mesh/mesh.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::protocols {

/// The forces that press seen bodies on a tick. Plain data, for the screen.
struct SeenForces {
  struct Force {
    std::int32_t vertex{0};          // of the HapticMesh
    std::array<float, 3> newtons{};  // on the body, in its own frame
  };
  static constexpr std::size_t kMost = 64;

  std::array<Force, kMost> forces{};                    // of one object after the other
  std::array<std::uint8_t, kMostSeenObjects> counts{};  // of each

  /// Forces on object `i`.
  std::span<const Force> on(std::size_t i) const noexcept;
  /// Adds forces on object `i`, not before those of an earlier one. If they do not fit, the
  /// strongest stay. Servo thread: no allocation or throw.
  void add(std::size_t i, std::span<const deformable::VertexForce> more) noexcept;
};

/// How a body gives way: at rest on every tick by forces that press it, or by its own motion.
struct SeenBody {
  deformable::SharedCompliance resting;  // null: it moves
  deformable::SharedMovingBody moving;
  std::shared_ptr<deformable::MovingShape> shape;  // of what moves

  bool operator==(const SeenBody&) const = default;
  explicit operator bool() const { return resting != nullptr || shape != nullptr; }
};

/// How the bodies of a session's trials give way, by the numbers of SeenObject::body. The session's
/// thread numbers them before a pass, the screen's asks for them; the servo thread does neither.
class SeenBodies {
 public:
  /// The same body gets the same number as long as it is in use.
  std::int32_t number_of(const SeenBody& body);
  /// The body of a number; none if there is none, or it is no longer in use.
  SeenBody body(std::int32_t number) const;

 private:
  mutable std::mutex mutex_;
  struct Used {
    std::weak_ptr<const deformable::Compliance> resting;
    std::weak_ptr<const deformable::MovingBody> moving;
    std::weak_ptr<deformable::MovingShape> shape;
    SeenBody lock() const { return {resting.lock(), moving.lock(), shape.lock()}; }
  };
  std::vector<Used> bodies_;
};

using Outline = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;  // lines in W [m]

/// Lines of an object that is seen along a direction: the sides of triangles where the surface
/// turns away from the eye, and its creases.
/// @param along  of the view in W, away from the eye, of length 1
Outline outline_of(const geometry::Mesh& mesh, const SeenObject& seen,
                   const Eigen::Vector3d& along);

}  // namespace haptrial::protocols
