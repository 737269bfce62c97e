#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/deformable/touch/ball_touch.h"
#include "protocols/trials/objects/trial_object.h"

namespace haptrial::protocols {

/// The forces that press seen bodies on a tick. Plain data, for the screen.
struct SeenForces {
  struct Force {
    std::int32_t vertex{0};          // of the FeltMesh
    std::array<float, 3> newtons{};  // on the body, in its own frame
  };
  static constexpr std::size_t kMost = 64;

  std::array<Force, kMost> forces{};                    // of one object after the other
  std::array<std::uint8_t, kMostSeenObjects> counts{};  // of each

  /// Those on object `i`.
  std::span<const Force> on(std::size_t i) const noexcept;
  /// Adds forces on object `i`, not before those of an earlier one. If they do not fit, the
  /// strongest stay. Servo thread: no allocation or throw.
  void add(std::size_t i, std::span<const deformable::VertexForce> more) noexcept;
};

/// How the bodies of a session's trials give way, by the numbers of SeenObject::body. The session's
/// thread numbers them before a pass, the screen's asks for them; the servo thread does neither.
class SeenBodies {
 public:
  /// The same body gets the same number as long as it is in use.
  std::int32_t number_of(const deformable::SharedCompliance& body);
  /// Null if there is none, or it is no longer in use.
  deformable::SharedCompliance body(std::int32_t number) const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<const deformable::Compliance>> bodies_;
};

}  // namespace haptrial::protocols
