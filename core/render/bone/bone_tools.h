#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/base/tool_state.h"
#include "core/bone/drill/burr_shape.h"
#include "core/geometry/mesh/mesh.h"
#include "core/render/bone/bone_shading.h"

namespace haptrial::render {

/// Meshes of tools in the tool frame T, whose origin is the burr's centre or the tube's opening and
/// whose z axis runs along the handle.
/// A burr's shaft: 1.2 mm, or two fifths of a thick burr; never thicker than the burr [m].
double burr_shaft(double diameter) noexcept;
geometry::Mesh burr_mesh(double diameter, double shaft_diameter, double length);
/// The same with the blades of a cutting burr, within its diameter.
/// @param clockwise  seen from the handle: the blades' sharp sides face the way it turns
geometry::Mesh cutting_burr_mesh(double diameter, double shaft_diameter, double length,
                                 bool clockwise);
/// Parts of such a burr that keep light off: the ball, the shaft and the handle.
std::vector<Capsule> burr_shadow(double diameter, double shaft_diameter, double length);

/// A burr of any shape with its shaft and handle.
struct BurrLook {
  bone::BurrDimensions head;
  bool cutting{false};         // it has blades
  bool clockwise{true};        // as of cutting_burr_mesh()
  double shaft_diameter{0.0};  // > 0 [m]
  double shaft_length{0.0};    // from the burr's end on; 0: half of the tool [m]
  double length{0.0};          // of all, from the burr's centre [m]
};
geometry::Mesh burr_mesh(const BurrLook& look);
std::vector<Capsule> burr_shadow(const BurrLook& look);
geometry::Mesh suction_mesh(double inner_diameter, double outer_diameter, double length);
/// A saw's blade from its teeth at negative z on, x along its width, with its handle.
struct SawLook {
  double width{0.0};      // > 0 [m]
  double kerf{0.0};       // > 0 [m]
  double teeth{0.0};      // length of the cutting end, whose middle is the origin > 0 [m]
  double sheet{0.0};      // behind it > 0 [m]
  double thickness{0.0};  // of the sheet > 0 [m]
  double length{0.0};     // of all, from the origin [m]
};
geometry::Mesh saw_mesh(const SawLook& look);
/// A screw whose head lies on z = 0 and whose thread goes down.
geometry::Mesh screw_mesh(double diameter, double length);
/// A rectangle in the plane z = 0 around the origin, seen from both sides.
geometry::Mesh plane_mesh(double width, double height);
/// Pose of a tool, from T to W.
Eigen::Isometry3d pose_of(const ToolState& tool);

}  // namespace haptrial::render
