#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

#include "core/scene/deformable_object.h"
#include "core/scene/detent.h"
#include "core/scene/friction.h"
#include "core/scene/hold.h"
#include "core/scene/inertia.h"
#include "core/scene/mover.h"
#include "core/scene/path.h"
#include "core/scene/push.h"
#include "core/scene/registered_law.h"
#include "core/scene/relief.h"
#include "core/scene/rigid_object.h"
#include "core/scene/surface.h"
#include "core/scene/vibration.h"
#include "core/scene/viscous.h"

namespace haptrial::scene {

/// The parameters of every kind of field; each struct's header has its law, units and bounds.
using FieldKind =
    std::variant<ConstantParameters, RampParameters, PulseParameters, MeasuredParameters,
                 SpringParameters, LineChannelParameters, AxisChannelParameters, PlaneParameters,
                 SurfaceParameters, GratingParameters, TextureParameters, ViscousParameters,
                 MatrixViscousParameters, InertiaParameters, FrictionParameters,
                 SineVibrationParameters, NoiseVibrationParameters, TapParameters, DetentParameters,
                 ClickParameters, MoverParameters, PathParameters, CurveParameters,
                 RigidObjectParameters, DeformableObjectParameters, RegisteredParameters>;

/// One field of force as a definition states it: plain data that may change between trials.
struct Field {
  std::string name;  // of the table [fields.NAME]; other fields lie `on` it by this name
  FieldKind kind;
  double limit{10.0};     // the force is scaled to at most this, its direction kept > 0 [N]
  double fade_in{0.05};   // after it is switched on >= 0 [s]
  double fade_out{0.05};  // after it is switched off >= 0 [s]
};

/// The surface that a field lies on; empty if it has none.
const std::string& surface_of(const Field& field) noexcept;

inline FieldTraits traits_of(const Field& field) {
  return std::visit([](const auto& p) { return p.traits(); }, field.kind);
}

}  // namespace haptrial::scene
