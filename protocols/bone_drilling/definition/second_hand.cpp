#include "protocols/bone_drilling/definition/second_hand.h"

#include "core/base/definition/schema.h"
#include "core/record/table/schema.h"

namespace haptrial::protocols {

static const Schema<bone::ToolContactParameters>& tool_contact_schema() {
  using P = bone::ToolContactParameters;
  static const auto schema =
      Schema<P>()
          .number("tool_stiffness", &P::stiffness, {0.0, 5000.0}, "N/m",
                  "Stiffness of the contact between the tube and the tool in the first hand; 0: "
                  "they pass through each other")
          .number("tool_damping", &P::damping, {0.0, 100.0}, "s/m",
                  "Damping by which the speed of approach makes the contact between tube and tool "
                  "stiffer");
  return schema;
}

static const Schema<bone::TubeParameters>& tube_schema() {
  using P = bone::TubeParameters;
  static const auto schema =
      Schema<P>()
          .number("radius", &P::radius, {2e-4, 0.01}, "m",
                  "Radius of the opening of the tube at a second device, which sucks and rinses")
          .number("handle_length", &P::handle_length, {1e-3, 0.5}, "m",
                  "Length of the tube in the second hand")
          .number("rinse_reach", &P::rinse_reach, {5e-4, 0.05}, "m",
                  "Distance that the water reaches from the tube's end")
          .number("shaft_length", &P::shaft_length, {0.0, 0.1}, "m",
                  "Length of the tube behind its end by which bone is felt, too")
          .derive([](P& p) { p.feel = bone::default_feel(p.outer_radius()); })
          .table("feel", &P::feel, bone::feel_schema(),
                 "Strength with which bone pushes the tube back")
          .keys_of(&P::at_tool, tool_contact_schema());
  return schema;
}

const Schema<SecondHandParameters>& second_hand_schema() {
  using P = SecondHandParameters;
  static const auto schema =
      Schema<P>()
          .keys_of(&P::tube, tube_schema())
          .vector("handle", &P::handle, {-1.0, 1.0}, "",
                  "Direction from the tip along the handle of the second device")
          .required()
          .check([](Table& table, P& p) {
            if (!(p.handle.norm() > 0.0)) {
              table.reject("handle", "is zero; write the direction from the tip along the handle");
              p.handle = Eigen::Vector3d::UnitY();
            }
          })
          .number("force_limit", &P::force_limit, {0.0, 100.0, true}, "N",
                  "Greatest force that the second device is given")
          .bits("suck", &P::suck, "Buttons of the second device that make the tube suck")
          .otherwise("[0]")
          .bits("rinse", &P::rinse, "Buttons of the second device that let water run")
          .otherwise("[1]");
  return schema;
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
