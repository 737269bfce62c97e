#include "analysis/bone_drilling/metrics/injuries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/bone_drilling/metrics/in_order.h"
#include "analysis/bone_drilling/metrics/study_bones.h"
#include "core/bone/drill/sight.h"

namespace haptrial::analysis::drilling {
namespace {

bone::Voxel nearest_voxel(const geometry::VoxelGrid& grid, const Eigen::Vector3d& point) {
  bone::Voxel voxel;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = grid.size[static_cast<std::size_t>(axis)] - 1;
    const double place = std::round((point[axis] - grid.origin[axis]) / grid.spacing);
    voxel[axis] = static_cast<int>(std::clamp(place, 0.0, last));
  }
  return voxel;
}

double largest_reach(const std::vector<ProcedureTool>& tools) {
  double reach = 0.0;
  for (const ProcedureTool& tool : tools) {
    reach = std::max(reach, burr_of({}, &tool).reach());
  }
  return reach;
}

}  // namespace

InjuryMeter::InjuryMeter(std::shared_ptr<const bone::BoneModel> bone,
                         const Eigen::Isometry3d& pose_WB, const std::vector<ProcedureTool>& tools,
                         StudyBones& bones)
    : bone_(std::move(bone)), pose_BW_(pose_WB.inverse()) {
  // The distance from the tip to its voxel's centre, and from a touched voxel's surface to its
  // centre, is half a diagonal each.
  const double spacing = bone_->grid.spacing;
  const double reach =
      std::min(largest_reach(tools) + std::numbers::sqrt3 * spacing, 250.0 * spacing);
  std::array<bool, 256> there{};
  for (const std::uint8_t label : bone_->labels) {
    there[label] = true;
  }
  for (std::size_t label = 1; label < bone_->structures.size(); ++label) {
    if (bone_->structures[label].vital && there[label]) {
      Injury injury;
      injury.structure = bone_->structures[label].name;
      injury.label = static_cast<std::uint8_t>(label);
      injuries_.push_back(injury);
      fields_.push_back(bones.field(bone_, static_cast<std::uint8_t>(label), reach));
    }
  }
}

void InjuryMeter::tick(const ToolTick& tick, const BurrOnTick& burr, double time) {
  if (!(burr.radius > 0.0) || !tick.power || !tick.drives_tool || !tick.position.allFinite()) {
    return;
  }
  const BurrOnTick burr_B = in_frame(pose_BW_, burr);
  for (std::size_t i = 0; i < injuries_.size(); ++i) {
    if (!injuries_[i].first_contact && touches(i, burr_B)) {
      injuries_[i].first_contact = time;
    }
  }
}

/// The tip clamped into the grid is nowhere farther from a voxel than the tip itself.
bool InjuryMeter::touches(std::size_t injury, const BurrOnTick& burr_B) const {
  const Eigen::Vector3d& centre = burr_B.centre;
  const double reach = burr_B.reach();
  const geometry::VoxelGrid& grid = bone_->grid;
  const bone::Voxel middle = nearest_voxel(grid, centre);
  const std::optional<double> distance = fields_[injury]->at(middle);
  if (!distance || *distance > reach + std::numbers::sqrt3 * grid.spacing) {
    return false;
  }
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(reach + grid.spacing);
  const bone::Voxel low = nearest_voxel(grid, centre - half);
  const bone::Voxel high = nearest_voxel(grid, centre + half);
  for (int k = low.z(); k <= high.z(); ++k) {
    for (int j = low.y(); j <= high.y(); ++j) {
      for (int i = low.x(); i <= high.x(); ++i) {
        if (bone_->labels[grid.index(i, j, k)] == injuries_[injury].label &&
            burr_B.touches(grid, {i, j, k})) {
          return true;
        }
      }
    }
  }
  return false;
}

void InjuryMeter::remove(const Removal& removal, double time) {
  for (Injury& injury : injuries_) {
    if (injury.label == removal.label) {
      ++injury.voxels;
      injury.first_removal = injury.first_removal.value_or(time);
    }
  }
}

void InjuryMeter::crumble(const std::vector<bone::Voxel>& voxels) {
  for (const bone::Voxel& voxel : voxels) {
    const std::uint8_t label = bone_->labels[bone_->grid.index(voxel)];
    for (Injury& injury : injuries_) {
      injury.crumbled += injury.label == label ? 1 : 0;
    }
  }
}

std::uint64_t InjuryMeter::voxels() const noexcept {
  std::uint64_t sum = 0;
  for (const Injury& injury : injuries_) {
    sum += injury.voxels;
  }
  return sum;
}

std::optional<double> opened_at(const Injury& injury) {
  if (injury.first_tear && !(injury.first_removal < injury.first_tear->time)) {
    return injury.first_tear->time;
  }
  return injury.first_removal;
}

void add_tears(const Procedure& procedure, std::vector<Injury>& injuries) {
  for (const Torn& tear : procedure.tears) {
    auto injury = std::find_if(injuries.begin(), injuries.end(),
                               [&](const Injury& each) { return each.label == tear.label; });
    if (injury == injuries.end()) {  // soft, but not vital
      Injury more;
      more.structure = procedure.bone->structures.at(tear.label).name;
      more.label = tear.label;
      injury = injuries.insert(injuries.end(), std::move(more));
    }
    ++injury->tears;
    if (!injury->first_tear) {
      const auto until = std::upper_bound(
          procedure.ticks.begin(), procedure.ticks.end(), tear.sequence,
          [](std::uint64_t value, const ToolTick& tick) { return value < tick.sequence; });
      const auto ticks = static_cast<double>(until - procedure.ticks.begin());
      injury->first_tear =
          FirstTear{ticks / procedure.rate, tear.force, tear.by_suction, tear.place};
    }
  }
}

std::vector<Injury> injuries(const Procedure& procedure, StudyBones& bones) {
  struct Visitor {
    const Procedure& procedure;
    InjuryMeter meter;
    StandingBone bone;
    std::uint64_t ticks{0};
    std::vector<bone::Voxel> taken{};
    double time() const { return static_cast<double>(ticks) / procedure.rate; }
    void view(const View&) {}
    void crumb(const Debris& crumb) {
      taken.clear();
      bone.take_part(crumb.voxel, &taken);
      meter.crumble(taken);
    }
    void tick(const ToolTick& tick) {
      ++ticks;
      meter.tick(tick, burr_of(tick, procedure.tool(tick.tool)), time());
    }
    void removal(const Removal& removal) {
      bone.take(removal.voxel);
      meter.remove(removal, time());
    }
    void cut(const Removal& cut) { removal(cut); }
  };
  Visitor visitor{procedure, InjuryMeter(procedure.bone, procedure.pose_WB, procedure.tools, bones),
                  StandingBone(procedure.bone)};
  visit_in_order(procedure, visitor);
  std::vector<Injury> all = visitor.meter.injuries();
  add_tears(procedure, all);
  return all;
}

}  // namespace haptrial::analysis::drilling
