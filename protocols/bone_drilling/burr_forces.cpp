#include "protocols/bone_drilling/burr_forces.h"

#include <algorithm>
#include <cmath>

#include "core/bone/drill/burr_shape.h"
#include "protocols/bone_drilling/definition/contact_margin.h"

namespace haptrial::protocols {
namespace {

constexpr int kDepths = 60;

/// Spacing of the definition's bones; that of their voxels where it states none [m].
double spacing_of(const BoneDefinition& d) {
  constexpr double kUnknown = 0.5e-3;
  return d.spacing ? *d.spacing : d.bones.empty() ? kUnknown : d.bones.front()->grid.spacing;
}

/// Leads the burr into the bone from above, a depth a tick.
void press(const bone::BoneModel& model, const bone::SimulatorParameters& parameters, double tip,
           double dt, BurrForce& force) {
  bone::Simulator simulator(model, parameters);
  simulator.begin(0);
  bone::SimulatorInput input;
  input.dt = dt;
  input.tool.tip.position.z() = tip + model.grid.spacing;  // free at first, else nothing is felt
  simulator.tick(input);
  for (const double depth : force.depths) {
    input.tool.tip.position.z() = tip - depth;
    force.forces.push_back(simulator.tick(input).force);
  }
}

}  // namespace

bone::BoneModel flat_bone_for(double spacing, double radius) {
  bone::BoneModel model;
  const int half = static_cast<int>(std::ceil(radius / spacing)) + 2;
  const int wide = 2 * half, high = 2 * half + 2;
  model.name = "flat bone";
  model.source = "made for a preview";
  model.grid = {{wide, wide, high},
                {-spacing * (half - 0.5), -spacing * (half - 0.5), -spacing * (high - 2 - 0.5)},
                spacing};
  model.structures = {{}, {bone::kPlainBone}};
  model.labels.resize(model.grid.count());
  std::size_t voxel = 0;
  for (int k = 0; k < high; ++k) {
    for (int i = 0; i < wide * wide; ++i) {
      model.labels[voxel++] = model.grid.centre(0, 0, k).z() < 0.0 ? 1 : 0;
    }
  }
  return model;
}

bone::SimulatorParameters simulator_of_burr(const BoneDefinition& d, const bone::ToolSpec& tool) {
  bone::SimulatorParameters parameters = d.simulator;
  parameters.tools = {tool};
  parameters.pose_WB = Eigen::Isometry3d::Identity();
  parameters.soft_tissue.clear();
  parameters.tube.reset();
  parameters.heat.reset();
  parameters.bleeding = {};
  return parameters;
}

std::vector<BurrForce> burr_forces(const BoneDefinition& d) {
  std::vector<BurrForce> all;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    if (burr == nullptr) {
      continue;
    }
    BurrForce force{tool.name, *burr, {}, {}, flat_bone_stiffness(*burr, d.drilling.force_limit)};
    const bone::BurrShape shape(burr->burr.dimensions());
    const double deepest = std::min(burr->radius(), shape.half_length());
    for (int i = 0; i <= kDepths; ++i) {
      force.depths.push_back(deepest * i / kDepths);
    }
    press(flat_bone_for(spacing_of(d), shape.reach()), simulator_of_burr(d, tool),
          shape.half_length(), 1.0 / d.rate, force);
    all.push_back(std::move(force));
  }
  return all;
}

}  // namespace haptrial::protocols
