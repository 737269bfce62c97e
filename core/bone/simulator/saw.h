#pragma once

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/burr_tool.h"

namespace haptrial::bone {

/// A sagittal saw: a flat blade with teeth at its end, which swings by a few degrees in its own
/// plane. In the tool frame T the blade is `width` along x and `kerf` along y, and its sheet runs
/// from the teeth to the hand along z.
struct SawParameters {
  double width{8e-3};         // of the blade, from 0.002 to 0.03 [m]
  double kerf{0.8e-3};        // of the slot that the teeth cut, from 0.0003 to 0.003 [m]
  double length{20e-3};       // of the sheet behind the teeth > 0 [m]
  double removal_rate{60.0};  // share of the immersed volume >= 0 [1/s]
  double stiffness{8e3};      // of bone under the whole of the teeth's largest side > 0 [N/m]
  double wear_volume{0.0};    // of bone, after which it removes half as much; 0: never [m^3]
};

/// The keys of a saw.
const Schema<SawParameters>& saw_schema();

/// The saw as a burr: its teeth are a box of samples that take bone, its sheet is a shaft, a box
/// that is felt and takes none. The sheet is thinner and narrower than the teeth, as those of a
/// saw are set, so that it runs free in a straight slot and meets the walls of it where the hand
/// turns or leans sideways. What is felt is bone_force(), as of a burr; without turning teeth
/// nothing pulls along the bone. The source has a plane that cuts without force instead: Morris
/// 2006, §3.2.5; saws are named in §3.1.2.
BurrTool saw_tool(const SawParameters& saw);

/// Whether a burr tool is a saw.
inline bool is_saw(const BurrTool& tool) noexcept { return tool.burr.form == BurrForm::kBlade; }

/// Force by which a tool removes bone in Drill::remove(): of a burr all of it; of a saw 1 N times
/// the share of the force that points back along the blade. Teeth that swing clear what they are in
/// at their own rate, be it little or much, so that the feed still follows the force by how deep
/// they are pressed in, and leaning on the blade cuts nothing. Servo thread.
/// @param force  of bone on the tool, in W [N]
double removal_force(const BurrTool& tool, const Eigen::Vector3d& force,
                     const Eigen::Vector3d& axis) noexcept;

/// The rubbing teeth as heat has them (DrillHeat).
struct Rubbing {
  double force;   // along the bone [N]
  double radius;  // of a burr whose surface is as fast [m]
};
/// @param force, drag  of bone on the tool, all of it and that of turning teeth, in W [N]. Servo
/// thread.
Rubbing rubbing_of(const BurrTool& tool, const Eigen::Vector3d& force, const Eigen::Vector3d& drag,
                   const Eigen::Vector3d& axis) noexcept;

}  // namespace haptrial::bone
