#pragma once

#include <Eigen/Core>

#include "core/control/pd_controller.h"
#include "core/scene/field_state.h"
#include "core/scene/shape.h"

namespace haptrial::scene {

class Surface;

struct SurfaceParameters {
  using Law = Surface;
  Shape shape;
  bool felt_from_inside{false};        // then the hand is kept in the shape, else out of it
  control::PdGains gains{800.0, 2.0};  // k >= 0 [N/m], b >= 0 [N·s/m]

  StiffnessBound bound() const;
  FieldTraits traits() const;
};

/// The sum of the reliefs on a surface at a place.
struct ReliefHere {
  double height{0.0};                              // h [m]
  Eigen::Vector3d slope{Eigen::Vector3d::Zero()};  // its gradient in W
  double steepest{0.0};                            // bound of the gradient's length anywhere
  double highest{0.0};                             // bound of the height anywhere [m]
  bool passes{false};   // the hand moves over its ridges, so that their force is to alternate
  bool changed{false};  // other numbers of a relief came with this tick
};

/// A wall, box, sphere or cylinder that pushes the hand out along its normal n, with relief h:
///
///     e = depth + h(p),  g = n - ∇h,  f = clip(k e - b c(e) g · v, 0, F) g  if e > 0, else 0
///
/// n points to the free side; depth is the distance behind the surface; c is contact::damper_share,
/// so that the damper does not strike the hand. The hand is never pulled. Over the last 2 mm before
/// the middle of a sphere, box or cylinder the force fades, so that it does not turn round at once;
/// inside a box or cylinder it turns over up to 2 mm from one face to the next, with the same
/// potential. F = limit / (1 + steepest slope), so that |f| stays within the limit. Passive: f at
/// rest is minus the gradient of phi(e) with phi' = clip(k e, 0, F), and clip is monotone, so the
/// damper takes energy. Reliefs tilt the force against the way uphill, as on real ridges, and
/// change it along the normal (Minsky 1995 has the lateral part alone).
class Surface {
 public:
  Surface(const SurfaceParameters& parameters, const Setting& setting);

  void lay(const ReliefHere& relief) noexcept { relief_ = relief; }  // before force() or energy()
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  double energy(const Eigen::Vector3d& p) const noexcept;  // [J]
  /// The energy at a depth [m], with a share of the stiffness [J].
  double stored(double depth, double share) const noexcept;
  const SurfaceTouch& touch() const noexcept { return touch_; }

 private:
  /// Seen from where the hand is free.
  struct Side {
    double depth;            // behind the surface; negative: free [m]
    Eigen::Vector3d normal;  // n
    double share;            // length of the depth's gradient: 1, and 0 in the middle of a shape
  };
  Side free_side(const Eigen::Vector3d& p) const noexcept;
  Eigen::Vector3d flat_force(const Side& here, const Felt& felt) const noexcept;

  PlacedShape shape_;
  bool inside_;
  control::PdGains gains_;
  double limit_;
  double deepest_;  // depth of the middle [m]
  double core_;     // over which the force fades before it [m]
  ReliefHere relief_;
  SurfaceTouch touch_;
};

}  // namespace haptrial::scene
