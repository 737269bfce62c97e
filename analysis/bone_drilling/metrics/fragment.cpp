#include "analysis/bone_drilling/metrics/fragment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/bone/data/anatomy.h"

namespace haptrial::analysis::drilling {
namespace {

using Eigen::Vector3d;

/// The labels of teeth, by their known names.
std::vector<bool> teeth_labels(const bone::BoneModel& bone) {
  constexpr auto kTooth = static_cast<std::uint8_t>(bone::Anatomy::kTooth);
  const std::string known = bone::known_structures()[kTooth].name;
  std::vector<bool> teeth;
  for (const bone::Structure& structure : bone.structures) {
    teeth.push_back(bone::structure_named(structure.name, kTooth).name == known);
  }
  return teeth;
}

}  // namespace

FragmentMeter::FragmentMeter(std::shared_ptr<const bone::BoneModel> bone,
                             const Eigen::Isometry3d& pose_WB, const subject::FragmentPlan& plan)
    : bone_(std::move(bone)), pose_WB_(pose_WB), plan_(plan) {
  const std::vector<bool> teeth = teeth_labels(*bone_);
  const geometry::VoxelGrid& grid = bone_->grid;
  std::ptrdiff_t more = 0;  // voxels beyond the cut than on its other side
  geometry::visit_voxels(grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (bone_->labels[at] == 0) {
      return;
    }
    const Vector3d place = pose_WB_ * grid.centre(voxel);
    const bool beyond = (place - plan_.point).dot(plan_.normal) > 0.0;
    more += beyond ? 1 : -1;
    if (beyond && teeth[bone_->labels[at]]) {
      teeth_.push_back(place);
    }
  });
  stays_ = more > 0;
}

void FragmentMeter::add(const record::PieceRow& row) {
  Piece& piece = pieces_[row.piece];
  piece.voxels = std::max(piece.voxels, row.voxels);
  piece.motion.linear() = subject::rotation_by(row.turn);
  piece.motion.translation() = row.shift;
}

void FragmentMeter::add(const record::ScrewRow& row) { screws_[{row.plate, row.hole}] = row; }

void FragmentMeter::remove(const bone::Voxel& voxel) {
  const Vector3d place = pose_WB_ * bone_->grid.centre(voxel);
  const double off = (place - plan_.point).dot(plan_.normal);
  off_squares_ += off * off;
  ++removed_;
}

FragmentFit FragmentMeter::fit() const {
  FragmentFit fit;
  if (removed_ > 0) {
    fit.off_cut = std::sqrt(off_squares_ / static_cast<double>(removed_));
  }
  for (const auto& [hole, screw] : screws_) {
    fit.purchase += screw.purchase;
    fit.screws += screw.purchase >= kHoldingPurchase ? 1 : 0;
    fit.screws_in_bone +=
        screw.purchase >= kHoldingPurchase && (screw.piece == 0) != stays_ ? 1 : 0;
  }
  const auto largest = std::max_element(
      pieces_.begin(), pieces_.end(),
      [](const auto& a, const auto& b) { return a.second.voxels < b.second.voxels; });
  if (largest == pieces_.end()) {
    return fit;
  }
  fit.came_off = true;
  const Eigen::Isometry3d& moved = largest->second.motion;
  const Eigen::Isometry3d motion = stays_ ? moved.inverse() : moved;
  const Eigen::Isometry3d planned = plan_.motion();
  const Vector3d error = motion * plan_.point - planned * plan_.point;
  fit.gap = error.dot(plan_.normal);
  fit.step = (error - fit.gap * plan_.normal).norm();
  fit.turn = Eigen::AngleAxisd(motion.linear() * planned.linear().transpose()).angle();
  double sum = 0.0;
  double most = 0.0;
  for (const Vector3d& place : teeth_) {
    const double off = (motion * place - planned * place).norm();
    sum += off;
    most = std::max(most, off);
  }
  if (!teeth_.empty()) {
    fit.bite_mean = sum / static_cast<double>(teeth_.size());
    fit.bite_most = most;
  }
  return fit;
}

}  // namespace haptrial::analysis::drilling
