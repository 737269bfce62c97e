#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/simulator/simulator.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// Force of flat bone on an upright burr that does not turn, by how deep its lowest point is.
struct BurrForce {
  std::string tool;  // its name
  bone::BurrTool burr;
  std::vector<double> depths;           // ascending [m]
  std::vector<Eigen::Vector3d> forces;  // (depths) of the simulator, in W [N]
  double stiffness{0.0};                // of flat bone at the definition's limit [N/m]
};

/// Bone below z = 0, of the definition's spacing, wide and deep enough for a burr.
/// @param spacing  edge of a voxel [m]  @param radius  of the burr's reach [m]
bone::BoneModel flat_bone_for(double spacing, double radius);
/// Parameters of a simulator with this tool alone, on that bone.
bone::SimulatorParameters simulator_of_burr(const BoneDefinition& definition,
                                            const bone::ToolSpec& tool);

/// The force of every burr of the definition, by the simulator of sessions.
std::vector<BurrForce> burr_forces(const BoneDefinition& definition);

}  // namespace haptrial::protocols
