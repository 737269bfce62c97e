#pragma once

#include <Eigen/Core>
#include <optional>

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

}  // namespace haptrial::scene
