#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/base/point_state.h"
#include "core/control/gain_shares.h"

namespace haptrial::scene {

/// How steeply a field's force may change, and whether it takes energy from every hand.
struct StiffnessBound {
  bool passive{false};    // in continuous time, once it is faded in
  double stiffness{0.0};  // K: bound of how fast the force over the place turns against it [N/m]
  double damping{0.0};    // B: bound of the force over the velocity that drives no motion [N·s/m]
  double driving{0.0};    // D: most force along the velocity over it; < 0: damps all [N·s/m]
};

/// Facts about a field that checks of a definition and the order of a scene ask for, whatever its
/// kind. The parameters of every kind answer by traits(), and by bound() without what lies on it.
struct FieldTraits {
  bool surface{false};      // other fields may lie on it
  bool closes_in{false};    // a surface that may lie around the hand
  bool relief{false};       // shapes the force of the surface that it lies on, has none of its own
  bool object{false};       // one of [objects], not of [fields]
  bool yields{false};       // only resists the hand; else its force works on it
  bool timed{false};        // its force has a course in time, from when it is switched on
  double asked_force{0.0};  // that it is to give, whatever the hand does [N]
  double mass{0.0};         // virtual [kg]
  double mass_cutoff{0.0};  // of the filter of the hand's acceleration that the mass takes [Hz]
  std::optional<Eigen::Vector3d> leads_to{};  // a hand that does nothing, in W [m]
};

/// How much the reliefs on a surface may steepen its force: sums of bounds of each. The usual ones
/// are those of ridges, and root mean squares of what is rough at random.
struct ReliefBound {
  double slope{0.0};            // |∇h|
  double curvature{0.0};        // of the second derivative of h [1/m]
  double usual_slope{0.0};      // |∇h|
  double usual_curvature{0.0};  // [1/m]
};

/// Settings of every law of a scene, whatever its kind.
struct Setting {
  double limit{10.0};   // of the field's force, > 0 [N]
  double rate{1000.0};  // of the servo loop, 1 / T > 0 [Hz]
};

/// A surface field's message to the fields that lie on it.
struct SurfaceTouch {
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // away from the material
  double pressing{0.0};                              // normal force >= 0, 0 without contact [N]
  double closing_speed{0.0};                         // into the material, along the normal [m/s]
};

/// Input of a law on a tick.
struct Felt {
  PointState hand;                       // finite
  double time{0.0};                      // since the field was switched on [s]
  const SurfaceTouch* surface{nullptr};  // of the surface it lies on; null in free space
  control::GainShares shares{};          // of its gains, which the law uses
  std::span<const double> channels{};    // values of channels (DeviceReading::channels)
};

/// State of a field after a tick that a protocol can read, to end a stage or to know what was felt.
struct FieldState {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the hand, limited and faded [N]
  /// The part of `force` whose course in time is itself the stimulus: a vibration, a tap, a pulse,
  /// ridges that the hand passes. Laws set it; the scene limits and fades it with the force. [N]
  Eigen::Vector3d stimulus{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // as the field filtered it [m/s]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};   // of a surface, towards the free side
  /// Surfaces and clicks: how deep the hand is in. Spring, channel, plane: how far it is from them.
  /// Mover: the way still to go; path: to the point that travels it; curve: to the curve. Grating,
  /// texture: the height under the hand. Friction: the bristle's deflection. [m]
  double depth{0.0};
  Eigen::Vector3d proxy{Eigen::Vector3d::Zero()};  // of a solid, in W [m]
  double weight{0.0};                              // of the fade, 0 to 1
  double stored{0.0};   // in the spring of a surface or a mesh, faded >= 0 [J]
  double added{0.0};    // of `stored`, since the share of its stiffness changed in this tick [J]
  bool contact{false};  // touches the surface; of other fields: gives a force
  bool limited{false};  // the limit cut the force of this tick
  bool sliding{false};  // friction: slides rather than sticks
  bool done{false};     // pulse, mover or path: over

  // Extremes since the field was switched on or forget_extremes() was called.
  double max_depth{0.0};  // [m]
  double max_force{0.0};  // [N]
  double work{0.0};       // done on the hand: the force held over each tick times the way [J]
};

}  // namespace haptrial::scene
