#include "protocols/bone_drilling/definition/second_hand.h"

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/record/table/rounding.h"
#include "core/record/table/schema.h"

namespace haptrial::protocols {

SecondHandParameters read_second_hand(Table& table) {
  SecondHandParameters p;
  bone::TubeParameters& tube = p.tube;
  tube.radius = table.number_or("radius", tube.radius, {2e-4, 0.01}, "m");
  tube.handle_length = table.number_or("handle_length", tube.handle_length, {1e-3, 0.5}, "m");
  tube.rinse_reach = table.number_or("rinse_reach", tube.rinse_reach, {5e-4, 0.05}, "m");
  tube.shaft_length = table.number_or("shaft_length", tube.shaft_length, {0.0, 0.1}, "m");
  tube.feel = bone::default_feel(tube.outer_radius());
  if (table.has("feel")) {
    Table feel = table.table("feel");
    bone::feel_schema().read(feel, tube.feel);
  }
  bone::ToolContactParameters& at_tool = tube.at_tool;
  at_tool.stiffness = table.number_or("tool_stiffness", at_tool.stiffness, {0.0, 5000.0}, "N/m");
  at_tool.damping = table.number_or("tool_damping", at_tool.damping, {0.0, 100.0}, "s/m");
  p.handle = read_vector(table, "handle", {-1.0, 1.0}, "");
  if (!(p.handle.norm() > 0.0)) {
    table.reject("handle", "is zero; write the direction from the tip along the handle");
    p.handle = Eigen::Vector3d::UnitY();
  }
  p.force_limit = table.number_or("force_limit", p.force_limit, {0.0, 100.0, true}, "N");
  p.suck = table.has("suck") ? read_bits(table, "suck") : p.suck;
  p.rinse = table.has("rinse") ? read_bits(table, "rinse") : p.rinse;
  return p;
}

/// /devices keeps 32 bits of positions and velocities, /second_hand a grid of orientations.
device::DeviceReading second_as_recorded(const device::DeviceReading& reading) noexcept {
  device::DeviceReading kept = reading;
  kept.tool.position = reading.tool.position.cast<float>().cast<double>();
  kept.tool.velocity = reading.tool.velocity.cast<float>().cast<double>();
  for (double& number : kept.orientation.coeffs()) {
    number = record::on_grid(number, record::kOrientationResolution);
  }
  return kept;
}

}  // namespace haptrial::protocols
