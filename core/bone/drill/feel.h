#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"
#include "core/bone/drill/drill.h"

namespace haptrial::bone {

/// How hard immersed bone pushes back.
struct FeelParameters {
  double first_gain{0.67e9};    // g_1 just after contact > 0 [N/m^3]
  double second_gain{2e9};      // g_2 deeper >= g_1 [N/m^3]
  double threshold{2e-10};      // immersed volume V_t where the gain changes > 0 [m^3]
  double force_limit{12.0};     // > 0 [N]
  double least_agreement{0.1};  // below this |push| / volume the force fades, from 0 to 1
};

/// Gains in proportion to 1 / radius, so that the depth under a given force is nearly the same for
/// every burr, but high enough for the smallest ones to carry the force limit before they sink in
/// whole. How stiff and how stable: docs/algorithms/bone-feel.md. @param burr_radius  > 0 [m]
FeelParameters default_feel(double burr_radius);

/// The keys of a [feel] table, all optional; read them into default_feel() of the burr.
const Schema<FeelParameters>& feel_schema();

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const FeelParameters& parameters);

/// The two-gain magnitude of an immersed volume [N]:
///
///     m(V) = min(g_1 V,                       force_limit)  where V <= V_t
///            min(g_1 V_t + g_2 (V - V_t),     force_limit)  else
///
/// Continuous and never falling; its slope changes at V_t and at the limit.
/// Source: Morris 2006, §3.2.3.5 (Figure 6). Servo thread: no allocation, lock or throw.
double magnitude(double volume, const FeelParameters& parameters) noexcept;

/// The force that pushes the burr out of the bone [N], in the frame of the contact:
///
///     f = m(V) push / max(|push|, least_agreement · V)
///
/// Deep inside bone the samples' directions cancel and there is no telling which way is out: the
/// force then fades evenly to zero instead of jumping about. Continuous in volume and push.
/// Source: Morris 2006, §3.2.3.4. Servo thread.
Eigen::Vector3d push_force(const Contact& contact, const FeelParameters& parameters) noexcept;

/// The force of the turning teeth along the bone [N], perpendicular to the burr's axis:
/// gain · power · (sum of (p - sc) x d over the immersed volume), d along the handle, for a burr
/// that turns counterclockwise seen from the handle; the opposite for one that turns clockwise, as
/// burrs do unless they are told otherwise. @param power  how fast the burr turns, from -1, in
/// reverse, to 1
/// Source: Morris 2006, §3.2.3.7. Servo thread.
Eigen::Vector3d drag_force(const Contact& contact, const BurrParameters& burr,
                           double power) noexcept;

/// Sum of both forces, shortened to the limit if it is longer [N]. Servo thread.
Eigen::Vector3d bone_force(const Contact& contact, const FeelParameters& parameters,
                           const BurrParameters& burr, double power) noexcept;

}  // namespace haptrial::bone
