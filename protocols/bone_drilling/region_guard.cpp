#include "protocols/bone_drilling/region_guard.h"

#include <utility>

namespace haptrial::protocols {

RegionGuard::RegionGuard(const bone::RegionSetup& setup, std::shared_ptr<const bone::RegionMap> map,
                         std::shared_ptr<hint::Chime> chime)
    : region_(setup, map), crossings_(map->labels()), chime_(std::move(chime)) {}

void RegionGuard::begin_pass(bool given) noexcept {
  given_ = given;
  tool_ = -1;
}

Eigen::Vector3d RegionGuard::tick(std::uint64_t sequence, const bone::Simulator& simulator,
                                  const bone::SimulatorInput& input, DrillingLogs& logs) noexcept {
  const bone::SimulatorOutput& out = simulator.output();
  const int tool = out.mode == bone::HandMode::kTool ? out.tool : -1;
  if (tool != tool_) {
    region_.forget();
    tool_ = tool;
  }
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  if (tool >= 0) {
    const Eigen::Isometry3d& X_WB = simulator.world().pose(0);
    force = X_WB.linear() * region_.tick(simulator.burr_balls(),
                                         X_WB.inverse(Eigen::Isometry) * input.tool.tip.position,
                                         X_WB.linear().transpose() * input.tool.axis());
  }
  if (crossings_.after_tick(sequence, given_, region_.depths(), logs.crossings) && given_ &&
      chime_) {
    chime_->ring();
  }
  return given_ ? force : Eigen::Vector3d::Zero();
}

}  // namespace haptrial::protocols
