#include "core/bone/drill/sight.h"

#include <array>
#include <utility>

#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {
namespace {

using Eigen::Vector3d;

/// Whether a burr comes near a cube. The search goes from the nearest surface point of a solid to
/// the nearest point of a cube and back, until they meet or come no nearer to each other: both are
/// convex.
bool meets(const BurrOnTick& burr, const Vector3d& low, const Vector3d& high,
           double close) noexcept {
  constexpr int kSteps = 100;
  Vector3d p = burr.centre.cwiseMax(low).cwiseMin(high);
  for (int step = 0; step < kSteps; ++step) {
    const Vector3d from = p - burr.centre;
    const double along = burr.axis.dot(from);
    const Vector3d lateral = from - along * burr.axis;
    const double across = lateral.norm();
    const BurrShape::Nearest near = burr.shape->nearest({across, 0.0, along});
    if (near.distance <= close) {
      return true;
    }
    const Vector3d outwards =
        near.normal.z() * burr.axis +
        (across > 0.0 ? Vector3d(near.normal.x() / across * lateral) : Vector3d(Vector3d::Zero()));
    const Vector3d next = (p - near.distance * outwards).cwiseMax(low).cwiseMin(high);
    if ((next - p).norm() < 0.01 * close) {
      return false;
    }
    p = next;
  }
  return false;
}

}  // namespace

bool BurrOnTick::touches(const geometry::VoxelGrid& grid, const Voxel& voxel) const noexcept {
  if (!(radius > 0.0)) {
    return false;
  }
  const Vector3d middle = grid.centre(voxel);
  const Eigen::Array3d beyond =
      ((centre - middle).array().abs() - 0.5 * grid.spacing).max(0.0);  // the cube, per axis
  const double farthest = reach();
  if (!(beyond.matrix().squaredNorm() <= farthest * farthest)) {
    return false;
  }
  const Vector3d half = Vector3d::Constant(0.5 * grid.spacing);
  return shape == nullptr || meets(*this, middle - half, middle + half, 1e-3 * grid.spacing);
}

BurrOnTick in_frame(const Eigen::Isometry3d& X, const BurrOnTick& burr) noexcept {
  BurrOnTick moved = burr;
  moved.centre = X * burr.centre;
  moved.axis = X.linear() * burr.axis;
  return moved;
}

StandingBone::StandingBone(std::shared_ptr<const BoneModel> bone)
    : bone_(std::move(bone)), bits_((bone_->grid.count() + 63) / 64, 0) {
  check(*bone_);
  for (std::size_t i = 0; i < bone_->labels.size(); ++i) {
    bits_[i / 64] |= static_cast<std::uint64_t>(bone_->labels[i] != 0) << (i % 64);
  }
}

bool StandingBone::take(const Voxel& voxel) noexcept {
  if (!inside(voxel) || !holds(voxel)) {
    return false;
  }
  const std::size_t at = grid().index(voxel);
  bits_[at / 64] &= ~(std::uint64_t{1} << (at % 64));
  return true;
}

void StandingBone::take_part(const Voxel& voxel, std::vector<Voxel>* taken) {
  static const std::array<Voxel, 6> kFaces{Voxel(1, 0, 0),  Voxel(-1, 0, 0), Voxel(0, 1, 0),
                                           Voxel(0, -1, 0), Voxel(0, 0, 1),  Voxel(0, 0, -1)};
  std::vector<Voxel> open;
  if (take(voxel)) {
    open.push_back(voxel);
  }
  while (!open.empty()) {
    const Voxel at = open.back();
    open.pop_back();
    if (taken != nullptr) {
      taken->push_back(at);
    }
    for (const Voxel& face : kFaces) {
      if (take(at + face)) {
        open.push_back(at + face);
      }
    }
  }
}

bool is_visible(const StandingBone& bone, const Voxel& voxel, const Eigen::Vector3d& eye,
                const BurrOnTick& burr) {
  const geometry::VoxelGrid& grid = bone.grid();
  bool visible = eye.allFinite();
  walk_voxels(grid, grid.centre(voxel), eye, [&](const Voxel& at, double, double) {
    if (bone.holds(at) && at != voxel && !burr.touches(grid, at)) {
      visible = false;
    }
    return visible;
  });
  return visible;
}

std::optional<double> Visibility::share() const {
  if (visible.empty()) {
    return std::nullopt;
  }
  return static_cast<double>(count) / static_cast<double>(visible.size());
}

VisibilityMeter::VisibilityMeter(std::shared_ptr<const BoneModel> bone,
                                 const Eigen::Isometry3d& pose_WB)
    : bone_(std::move(bone)), pose_BW_(pose_WB.inverse()) {}

void VisibilityMeter::look_from(const Eigen::Vector3d& eye) { eye_ = pose_BW_ * eye; }

bool VisibilityMeter::remove(const Voxel& voxel, const BurrOnTick& burr) {
  bone_.take(voxel);
  const bool seen =
      bone_.inside(voxel) && eye_ && is_visible(bone_, voxel, *eye_, in_frame(pose_BW_, burr));
  found_.visible.push_back(seen ? 1 : 0);
  found_.count += seen ? 1 : 0;
  return seen;
}

}  // namespace haptrial::bone
