#include "analysis/bone_drilling/metrics/achieved.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/bone_drilling/metrics/study_bones.h"

namespace haptrial::analysis::drilling {
namespace {

using subject::PlanPart;

constexpr double kStep = 0.01;  // of a path: noise of single ticks is no way [s]
constexpr double kCubicMillimetres = 1e9;

std::optional<double> in_unit(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::vector<AchievedFigure> of_cavity(const Achieved& a) {
  return {{"cavity_removed_percent", "planned cavity removed", "%",
           a.plan ? in_unit(a.plan->share(), 100.0) : std::nullopt},
          {"beyond_plan_mm3", "bone removed beyond the plan", "mm3",
           in_unit(a.beyond(), kCubicMillimetres)},
          {"tool_path_mm", "path of the tool", "mm", 1e3 * a.path},
          {"economy_mm3_per_m", "planned bone removed per metre of path", "mm3/m",
           in_unit(a.economy(), kCubicMillimetres)}};
}

/// An osteotomy has no planned volume, so that its path has no economy.
std::vector<AchievedFigure> of_fragment(const FragmentFit& f, double path) {
  const auto if_off = [&](double value) {
    return f.came_off ? std::optional(value) : std::nullopt;
  };
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return {{"cut_off_plane_mm", "removed bone off the planned cut, root mean square", "mm",
           in_unit(f.off_cut, 1e3)},
          {"fragment_gap_mm", "gap left at the cut against the plan", "mm", if_off(1e3 * f.gap)},
          {"fragment_step_mm", "step left at the cut against the plan", "mm", if_off(1e3 * f.step)},
          {"fragment_turn_deg", "fragment turned against the plan", "degrees",
           if_off(kDegrees * f.turn)},
          {"bite_mean_mm", "teeth off the planned bite, mean", "mm", in_unit(f.bite_mean, 1e3)},
          {"bite_most_mm", "teeth off the planned bite, at most", "mm", in_unit(f.bite_most, 1e3)},
          {"screws_fragment", "holding in the fragment", "screws",
           static_cast<double>(f.screws - f.screws_in_bone)},
          {"screws_bone", "holding in the bone itself", "screws",
           static_cast<double>(f.screws_in_bone)},
          {"screw_purchase_mm", "solid bone in the threads of all screws", "mm", 1e3 * f.purchase},
          {"tool_path_mm", "path of the tool", "mm", 1e3 * path}};
}

std::string column_of(const std::string& structure) {
  std::string column = "bone_left_" + structure + "_mm";
  std::replace_if(
      column.begin(), column.end(), [](char c) { return c == ' ' || c == ',' || c == '"'; }, '_');
  return column;
}

}  // namespace

std::vector<BoneLeft> untouched(const bone::BoneModel& bone) {
  std::vector<BoneLeft> left;
  for (const std::string& name : bone::vital_structures(bone)) {
    left.push_back({name, std::nullopt});
  }
  return left;
}

std::optional<double> PlanCount::share() const {
  return planned > 0 ? std::optional(static_cast<double>(removed) / static_cast<double>(planned))
                     : std::nullopt;
}

void PlanCount::add(PlanPart part) {
  removed += part == PlanPart::kPlanned ? 1 : 0;
  beyond += part == PlanPart::kBeyond ? 1 : 0;
  injured += part == PlanPart::kVital ? 1 : 0;
}

std::optional<double> Achieved::removed() const {
  return plan ? std::optional(voxel * static_cast<double>(plan->removed)) : std::nullopt;
}

std::optional<double> Achieved::beyond() const {
  return plan ? std::optional(voxel * static_cast<double>(plan->beyond)) : std::nullopt;
}

std::optional<double> Achieved::economy() const {
  return path > 0.0 ? in_unit(removed(), 1.0 / path) : std::nullopt;
}

std::vector<AchievedFigure> figures_of(const Achieved& a) {
  std::vector<AchievedFigure> figures =
      a.fragment ? of_fragment(*a.fragment, a.path) : of_cavity(a);
  for (const BoneLeft& left : a.left) {
    figures.push_back({column_of(left.structure), "bone left over the " + left.structure, "mm",
                       in_unit(left.thickness, 1e3), true});
  }
  return figures;
}

AchievedMeter::AchievedMeter(const ProcedurePlans& plans,
                             std::shared_ptr<const bone::BoneModel> bone,
                             const Eigen::Isometry3d& pose_WB, double rate, StudyBones& bones)
    : bone_(std::move(bone)),
      plan_(plans.cavity),
      gone_(bone_->labels.size(), false),
      step_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(kStep * rate)))) {
  achieved_.voxel = std::pow(bone_->grid.spacing, 3);
  if (plans.fragment) {
    fragment_.emplace(bone_, pose_WB, *plans.fragment);
  }
  if (plan_) {
    achieved_.plan.emplace().planned = plan_->planned;
  }
  achieved_.left = untouched(*bone_);
  for (const BoneLeft& left : achieved_.left) {
    fields_.push_back(bones.field(bone_, bone::labels_named(*bone_, left.structure),
                                  std::min(kLeftReach, 250.0 * bone_->grid.spacing)));
  }
  nearest_.resize(fields_.size());
}

void AchievedMeter::tick(const ToolTick& tick) {
  const auto length = [this] { return (last_.position - from_.position).norm(); };
  const bool driven = tick.drives_tool && tick.position.allFinite();
  const bool goes_on = on_path_ && driven && tick.sequence <= last_.sequence + step_;
  if (on_path_ && (!goes_on || last_.sequence >= from_.sequence + step_)) {
    achieved_.path += length();
    from_ = last_;
  }
  if (driven) {
    from_ = goes_on ? from_ : tick;
    last_ = tick;
  }
  on_path_ = driven;
}

void AchievedMeter::remove(const bone::Voxel& voxel) {
  const geometry::VoxelGrid& grid = bone_->grid;
  if (!grid.contains(voxel)) {
    return;
  }
  const std::size_t at = grid.index(voxel);
  if (gone_[at] || bone_->labels[at] == 0) {
    return;
  }
  gone_[at] = true;
  if (fragment_) {
    fragment_->remove(voxel);
  }
  if (plan_) {
    achieved_.plan->add(plan_->parts[at]);
  }
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (const auto distance = fields_[i]->at(voxel)) {
      nearest_[i] = std::min(nearest_[i].value_or(*distance), *distance);
    }
  }
}

void AchievedMeter::add(const record::PieceRow& row) {
  if (fragment_) {
    fragment_->add(row);
  }
}

void AchievedMeter::add(const record::ScrewRow& row) {
  if (fragment_) {
    fragment_->add(row);
  }
}

/// Between centres of neighbours lies no bone, so that a voxel's edge is taken off a distance.
Achieved AchievedMeter::achieved() const {
  Achieved achieved = achieved_;
  achieved.fragment = fragment_ ? std::optional(fragment_->fit()) : std::nullopt;
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    if (nearest_[i]) {
      achieved.left[i].thickness = std::max(0.0, *nearest_[i] - bone_->grid.spacing);
    }
  }
  achieved.path += on_path_ ? (last_.position - from_.position).norm() : 0.0;
  return achieved;
}

}  // namespace haptrial::analysis::drilling
