#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"
#include "core/base/point_state.h"
#include "core/control/gain_shares.h"

namespace haptrial::control {

/// Gains of a spring and damper. Source: Morris 2006, §4.2.4.
struct PdGains {
  double stiffness{900.0};  // k >= 0 [N/m]
  double damping{100.0};    // b >= 0 [N·s/m]
};

/// The keys of a table of gains, such as guidance.plane.
const Schema<PdGains>& pd_gains_schema();

/// Spring and damper that pull the tool tip T towards a moving target D:
///
///     f_W = k (p_WD - p_WT) + b (v_WD - v_WT)
///
/// W is the world frame (docs/conventions.md). Source: Morris 2006, §4.2.4.
class PdController {
 public:
  /// @throws std::invalid_argument naming the gain that breaks its bound.
  explicit PdController(const PdGains& gains);

  /// @param target, tip  in W.
  /// @param shares       of k and b that are used
  /// @returns the force on the tip [N]; zero where an input is not finite.
  /// Servo thread: no allocation, lock, I/O or throw.
  Eigen::Vector3d force(const PointState& target, const PointState& tip,
                        const GainShares& shares = {}) const noexcept;

  /// Energy in the spring [J], where it gives at most `limit` [N].
  /// @param stretch  from tip to target [m]
  /// @param share    of k that is used
  double stored(double stretch, double limit, double share = 1.0) const noexcept;

  const PdGains& gains() const noexcept { return gains_; }

 private:
  PdGains gains_;
};

/// `force` with its length limited to `limit` >= 0 [N] and its direction kept.
Eigen::Vector3d saturate(const Eigen::Vector3d& force, double limit) noexcept;

}  // namespace haptrial::control
