#pragma once

#include <Eigen/Core>
#include <string>

#include "core/scene/field_state.h"

namespace haptrial::scene {

class Friction;

struct FrictionParameters {
  using Law = Friction;
  enum class Model { kBristle, kDahl };
  std::string on;                // a surface field; empty in free space
  double static_level{0.5};      // coefficient on a surface, else force [N]; >= dynamic_level
  double dynamic_level{0.4};     // the same once it slides >= 0
  double stiffness{1000.0};      // of the bristle, sigma > 0 [N/m]
  Model model{Model::kBristle};  // Dahl: static and dynamic level are the same

  StiffnessBound bound() const { return {true, stiffness, 0.0}; }
  FieldTraits traits() const { return {.yields = true}; }
};

/// Dry friction by a bristle between the hand and a place of adhesion, with deflection z:
///
///     f = -sigma z,   |z| <= level N / sigma      (N = 1 in free space)
///
/// kBristle (Hayward and Armstrong 2000): z follows the hand's way; if it passes the static level,
/// the hand slides and z is cut to the dynamic level: break-away at static N, then dynamic N
/// against the movement; Coulomb's law if both are the same. The hand sticks again when it turns
/// back by a tenth of z or rests for 50 ms, so that an encoder's steps are no stops. kDahl (Dahl
/// 1968): dz = dx - |dx| z / z_max by an implicit step, without a corner between sticking and
/// sliding. On a surface z lies in the tangent plane.
///
/// The force follows the hand's way, not its velocity, so that noise of the velocity does not
/// matter and nothing drifts. Passive: ½ sigma |z|² is stored; cuts only reduce it.
class Friction {
 public:
  Friction(const FrictionParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Friction& before) noexcept;

 private:
  FrictionParameters parameters_;
  Eigen::Vector3d z_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};  // the hand a tick ago [m]
  bool sliding_{false};
  double slid_at_{0.0};  // time of the last way forward [s]
};

}  // namespace haptrial::scene
