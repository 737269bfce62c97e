#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/deformable/elements/implicit_motion.h"
#include "core/deformable/springs/spring_body.h"
#include "core/deformable/springs/spring_motion.h"
#include "core/deformable/touch/haptic_mesh.h"
#include "core/deformable/touch/tissue.h"

namespace haptrial::deformable {

/// Properties of a body of springs.
struct SpringTissue {
  UniformConstants constants;                         // everywhere the same [J]
  std::shared_ptr<const SpringConstants> calibrated;  // of each spring, instead; null: none
  double density{1000.0};                             // > 0 [kg/m³]
  double decay{0.0};  // a >= 0: a free motion dies down with exp(-a t) [1/s]

  bool operator==(const SpringTissue&) const = default;
};

/// Properties of a body of elements that is stepped implicitly.
struct ImplicitTissue {
  Tissue tissue;      // of neo-Hookean elements
  double decay{0.0};  // as SpringTissue has it [1/s]

  bool operator==(const ImplicitTissue&) const = default;
};

/// A body that is to be felt while it moves, the same for all who touch it: of springs, or of
/// elements that are stepped implicitly.
struct MovingBody {
  SharedHapticMesh mesh;
  std::vector<std::int32_t> held;                // vertices, those that the hand holds among them
  std::shared_ptr<const ElasticBody> elements;   // null: it is made of springs
  std::shared_ptr<const ImplicitBody> implicit;  // of the elements
  SpringBody springs;
  double drag{};         // of every vertex: 2 a times their mean mass [N·s/m]
  double stable_step{};  // springs/spring_tangent.h [s]
};
using SharedMovingBody = std::shared_ptr<const MovingBody>;

/// A moving body, made when it is first asked for and shared (touch/prepared.h). Any thread
/// but the servo thread. @throws InputError as spring_body()
SharedMovingBody prepared(const SharedHapticMesh& mesh, const SpringTissue& tissue);
/// @param step  of the body [s]  @throws InputError as check_tissue() and check_memory()
SharedMovingBody prepared(const SharedHapticMesh& mesh, const ImplicitTissue& tissue, double step);

inline constexpr int kMostSteps = 64;  // on a tick

/// The steps that a body makes on a tick of this period: one of elements one, a body of springs so
/// many that each is within kStableShare of its stable step: one that is pressed may be stiffer
/// than at rest.
/// @throws InputError naming the body and what mends it if that is more than kMostSteps.
int steps_on_a_tick(const MovingBody& body, double period);
inline constexpr double kStableShare = 0.8;

/// The motion of a body at rest. @param period  of elements the step that they were prepared for
/// @throws InputError as steps_on_a_tick()
std::unique_ptr<BodyMotion> motion_of(const MovingBody& body, double period);

}  // namespace haptrial::deformable
