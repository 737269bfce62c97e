#include "analysis/bone_drilling/metrics/usage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/bone_drilling/metrics/in_order.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr double kRest = 0.25;  // a view that stood still for longer begins to move anew [s]

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

UsageMeter::UsageMeter(std::shared_ptr<const bone::BoneModel> bone,
                       const std::vector<ProcedureTool>& tools, double rate)
    : bone_(std::move(bone)),
      period_(1.0 / rate),
      tool_ticks_(tools.size(), 0),
      tool_drilling_(tools.size(), 0) {
  for (const ProcedureTool& tool : tools) {
    usage_.tools.push_back({tool.name});
    burrs_.push_back(tool.burr_radius > 0.0);
  }
  for (std::size_t label = 0; label < bone_->structures.size(); ++label) {
    usage_.structures.push_back({bone_->structures[label].name, static_cast<std::uint8_t>(label)});
  }
}

void UsageMeter::tick(const ToolTick& tick) {
  usage_.tool_changes += ticks_ > 0 && tick.tool != tool_ ? 1 : 0;
  tool_ = tick.tool;
  ++ticks_;
  removed_ += tick.removed;
  const auto tool = static_cast<std::size_t>(tick.tool);
  if (tick.tool < 0 || tool >= tool_ticks_.size()) {
    return;
  }
  ++tool_ticks_[tool];
  if (burrs_[tool] && tick.drills()) {
    ++tool_drilling_[tool];
    ++drilling_;
    force_sum_ += tick.force;
    usage_.greatest_force = std::max(usage_.greatest_force.value_or(0.0), tick.force);
  }
}

void UsageMeter::remove(const Removal& removal) {
  const auto& grid = bone_->grid;
  for (int axis = 0; axis < 3; ++axis) {
    if (removal.voxel[axis] < 0 ||
        removal.voxel[axis] >= grid.size[static_cast<std::size_t>(axis)]) {
      return;
    }
  }
  const std::size_t at = grid.index(removal.voxel);
  const double density = bone_->density.empty() ? 1.0 : static_cast<double>(bone_->density[at]);
  const double volume = density * std::pow(grid.spacing, 3);
  if (removal.label < usage_.structures.size()) {
    ++usage_.structures[removal.label].voxels;
    usage_.structures[removal.label].volume += volume;
  }
  if (tool_ >= 0 && static_cast<std::size_t>(tool_) < usage_.tools.size()) {
    usage_.tools[static_cast<std::size_t>(tool_)].removed += volume;
  }
}

void UsageMeter::view(const View& view) {
  if (view_ && (view_->eye != view.eye || view_->target != view.target)) {
    usage_.camera_path += (view.eye - view_->eye).norm();
    usage_.camera_turn += angle_between(view_->target - view_->eye, view.target - view.eye);
    const double still = period_ * static_cast<double>(view.sequence - moved_);
    usage_.camera_moves += !has_moved_ || still > kRest ? 1 : 0;
    moved_ = view.sequence;
    has_moved_ = true;
  }
  view_ = view;
}

double UsageMeter::time() const noexcept { return period_ * static_cast<double>(ticks_); }

Usage UsageMeter::usage() const {
  Usage result = usage_;
  result.time = time();
  result.drilling = period_ * static_cast<double>(drilling_);
  result.removed = removed_ * std::pow(bone_->grid.spacing, 3);
  for (std::size_t tool = 0; tool < result.tools.size(); ++tool) {
    result.tools[tool].in_hand = period_ * static_cast<double>(tool_ticks_[tool]);
    result.tools[tool].drilling = period_ * static_cast<double>(tool_drilling_[tool]);
  }
  if (drilling_ > 0) {
    result.mean_force = force_sum_ / static_cast<double>(drilling_);
  }
  return result;
}

Usage usage(const Procedure& procedure) {
  struct Visitor {
    UsageMeter meter;
    void view(const View& view) { meter.view(view); }
    void crumb(const Debris&) {}
    void tick(const ToolTick& tick) { meter.tick(tick); }
    void removal(const Removal& removal) { meter.remove(removal); }
    void cut(const Removal& cut) { meter.remove(cut); }
  };
  Visitor visitor{UsageMeter(procedure.bone, procedure.tools, procedure.rate)};
  visit_in_order(procedure, visitor);
  return visitor.meter.usage();
}

}  // namespace haptrial::analysis::drilling
