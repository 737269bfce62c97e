#include "core/subject/drilling/cavity_plan.h"

#include <algorithm>

namespace haptrial::subject {
namespace {

/// Turns bone that should stand, in the 26 voxels around a planned one, into margin.
void mark_margin(const geometry::VoxelGrid& grid, int i, int j, int k,
                 std::vector<PlanPart>& parts) {
  for (int z = std::max(0, k - 1); z <= std::min(grid.size[2] - 1, k + 1); ++z) {
    for (int y = std::max(0, j - 1); y <= std::min(grid.size[1] - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(grid.size[0] - 1, i + 1); ++x) {
        PlanPart& part = parts[grid.index(x, y, z)];
        part = part == PlanPart::kBeyond ? PlanPart::kMargin : part;
      }
    }
  }
}

PlanPart part_of(const bone::BoneModel& model, std::uint8_t label, float depth) {
  if (depth >= 0.0F) {
    return PlanPart::kPlanned;
  }
  if (label == 0) {
    return PlanPart::kAir;
  }
  return model.structures[label].vital ? PlanPart::kVital : PlanPart::kBeyond;
}

}  // namespace

CavityPlan plan_of(const bone::BoneModel& model, const std::vector<float>& depths) {
  CavityPlan plan;
  plan.parts.resize(model.labels.size());
  for (std::size_t at = 0; at < plan.parts.size(); ++at) {
    plan.parts[at] = part_of(model, model.labels[at], depths[at]);
    plan.planned += plan.parts[at] == PlanPart::kPlanned ? 1 : 0;
  }
  std::size_t at = 0;
  for (int k = 0; k < model.grid.size[2]; ++k) {
    for (int j = 0; j < model.grid.size[1]; ++j) {
      for (int i = 0; i < model.grid.size[0]; ++i, ++at) {
        if (plan.parts[at] == PlanPart::kPlanned) {
          mark_margin(model.grid, i, j, k, plan.parts);
        }
      }
    }
  }
  return plan;
}

std::vector<float> planned_depths(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                  const CavityParameters& cavity, double burr_radius) {
  const DrillingChart chart = make_chart(model, X_WB, cavity);
  const BurrReach reach = burr_reach(chart, cavity_floor(chart), burr_radius);
  return cavity_depths(model, X_WB, chart, reach.floor);
}

bool is_gone_at(float depth, double share, float deepest) noexcept {
  return depth >= 0.0F && static_cast<double>(depth) <= share * static_cast<double>(deepest);
}

CavityPlan plan_cavity(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                       const CavityParameters& cavity, double burr_radius) {
  return plan_of(model, planned_depths(model, X_WB, cavity, burr_radius));
}

}  // namespace haptrial::subject
