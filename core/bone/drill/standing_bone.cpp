#include "core/bone/drill/standing_bone.h"

#include <array>
#include <utility>

namespace haptrial::bone {

StandingBone::StandingBone(std::shared_ptr<const BoneModel> bone)
    : bone_(std::move(bone)), bits_((bone_->grid.count() + 63) / 64, 0) {
  check(*bone_);
  for (std::size_t i = 0; i < bone_->labels.size(); ++i) {
    bits_[i / 64] |= static_cast<std::uint64_t>(bone_->labels[i] != 0) << (i % 64);
  }
}

bool StandingBone::inside(const Voxel& voxel) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] < 0 || voxel[axis] >= grid().size[static_cast<std::size_t>(axis)]) {
      return false;
    }
  }
  return true;
}

bool StandingBone::take(const Voxel& voxel) noexcept {
  if (!inside(voxel) || !holds(voxel)) {
    return false;
  }
  const std::size_t at = grid().index(voxel.x(), voxel.y(), voxel.z());
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

}  // namespace haptrial::bone
