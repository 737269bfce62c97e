#include "core/bone/simulator/saw.h"

#include <algorithm>

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

constexpr double kTeeth = 1.0e-3;        // length of the cutting end [m]
constexpr double kSet = 0.4;             // thickness of the sheet, as a share of the kerf
constexpr double kNarrow = 0.85;         // width of the sheet, as a share of the teeth's
constexpr double kTeethFriction = 0.5;   // assumed: rubbing over pressing force
constexpr double kTeethRadius = 0.4e-3;  // of a burr at 1000 turns a second: 2.5 m/s, as teeth that
                                         // swing by 2 mm 300 times a second [m]

/// Gains with which a side of so much area has the wanted stiffness when it lies on flat bone.
FeelParameters feel_of(double stiffness, double area) {
  FeelParameters feel;
  feel.second_gain = stiffness / area;
  feel.first_gain = feel.second_gain / 3.0;
  feel.threshold = 0.02e-3 * area;
  return feel;
}

}  // namespace

const Schema<SawParameters>& saw_schema() {
  using P = SawParameters;
  static const auto schema =
      Schema<P>()
          .number("width", &P::width, {0.002, 0.03}, "m", "Width of a saw's blade")
          .number("kerf", &P::kerf, {3e-4, 0.003}, "m",
                  "Width of the slot that a saw cuts; voxels that the blade touches go whole")
          .check([](Table& table, P& p) {
            if (p.kerf > 0.5 * p.width) {
              table.reject("kerf", "is more than half of width; a blade is flat");
            }
          })
          .number("length", &P::length, {1e-3, 0.1}, "m",
                  "Length of the blade behind its teeth, which bone guides")
          .number("removal_rate", &P::removal_rate, {0.0, 1000.0}, "1/s",
                  "Share of the bone within a saw's teeth that goes in a second")
          .tunable()
          .number("stiffness", &P::stiffness, {100.0, 1e5}, "N/m",
                  "Stiffness of bone under the largest side of the teeth, and of the blade")
          .number("wear_volume", &P::wear_volume, {0.0, 1.0, true}, "m3",
                  "Volume of bone after which the burr removes half as much")
          .otherwise("never");
  return schema;
}

BurrTool saw_tool(const SawParameters& saw) {
  BurrTool tool;
  tool.burr = default_burr(BurrKind::kCutting,
                           BurrDimensions{BurrForm::kBlade, saw.width, kTeeth, saw.kerf});
  tool.burr.removal_rate = saw.removal_rate;
  tool.burr.falloff = 0.0;
  tool.burr.tangential_gain = 0.0;
  tool.burr.wear_volume = saw.wear_volume;
  tool.feel = feel_of(saw.stiffness, saw.width * kTeeth);
  ShaftParameters sheet;
  sheet.form = BurrForm::kBlade;
  sheet.radius = 0.5 * kNarrow * saw.width;
  sheet.thickness = kSet * saw.kerf;
  sheet.length = saw.length;
  sheet.feel = feel_of(saw.stiffness, saw.width * saw.length);
  tool.shaft = sheet;
  return tool;
}

double removal_force(const BurrTool& tool, const Eigen::Vector3d& force,
                     const Eigen::Vector3d& axis) noexcept {
  const double all = force.norm();
  return is_saw(tool) && all > 0.0 ? std::max(0.0, force.dot(axis)) / all : all;
}

Rubbing rubbing_of(const BurrTool& tool, const Eigen::Vector3d& force, const Eigen::Vector3d& drag,
                   const Eigen::Vector3d& axis) noexcept {
  return is_saw(tool) ? Rubbing{kTeethFriction * std::max(0.0, force.dot(axis)), kTeethRadius}
                      : Rubbing{drag.norm(), tool.radius()};
}

}  // namespace haptrial::bone
