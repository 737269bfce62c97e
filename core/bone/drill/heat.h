#pragma once

#include "core/base/definition/schema_forward.h"

namespace haptrial::bone {

/// How a burr and the bone at it warm up. The values are assumed, not measured on bone.
struct HeatParameters {
  double turns{1000.0};     // of the burr at full power > 0 [1/s]
  double share{0.3};        // of the work of the teeth that stays as heat, 0 to 1
  double capacity{0.5};     // C of what is warmed > 0 [J/K]
  double loss{0.05};        // G to what lies around > 0 [W/K]
  double rinsed_loss{0.5};  // G under water >= loss [W/K]
  double body{37.0};        // temperature of what lies around [°C]
  double harmful{47.0};     // bone that is this hot for long dies [°C]
};

/// The keys of [heat], all optional.
const Schema<HeatParameters>& heat_schema();

/// The temperature at a burr, as one warm body that loses heat to what lies around it:
///
///     C T' = share · F · v - G (T - T_body),   v = 2π · turns · power · radius
///
/// with the force F of the teeth along the bone, integrated exactly for an F that stays for the
/// tick. A teacher's measure of pressing and of forgetting to rinse, no prediction for a patient:
/// docs/algorithms/two-hands.md. Servo thread: no allocation, lock or throw.
class DrillHeat {
 public:
  explicit DrillHeat(const HeatParameters& parameters) noexcept
      : p_(parameters), temperature_(parameters.body) {}

  /// @param drag    of the teeth along the bone >= 0 [N]
  /// @param radius  of the burr [m]
  /// @param power   with which it turns, 0 to 1
  /// @param rinsed  water runs over it
  void tick(double drag, double radius, double power, bool rinsed, double dt) noexcept;

  double temperature() const noexcept { return temperature_; }  // [°C]
  double hottest() const noexcept { return hottest_; }          // so far [°C]
  double harmful_time() const noexcept { return harmful_; }     // above `harmful`, so far [s]

 private:
  HeatParameters p_;
  double temperature_;
  double hottest_{0.0};
  double harmful_{0.0};
};

}  // namespace haptrial::bone
