#include "core/bone/surface/label_mix.h"

#include <algorithm>
#include <array>
#include <utility>

namespace haptrial::bone {

LabelMix::LabelMix(const BoneVolume& volume)
    : labels_(static_cast<std::size_t>(volume.bricks()), 0) {
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    std::uint8_t& one = labels_[static_cast<std::size_t>(brick)];
    for (int place = 0; place < BoneVolume::kBrickVoxels && one != kMixed; ++place) {
      const std::uint8_t label = volume.label(brick * BoneVolume::kBrickVoxels + place);
      one = one == 0 || label == 0 || label == one ? std::max(one, label) : kMixed;
    }
  }
}

bool LabelMix::is_mixed(const BoneVolume& volume, const Voxel& origin) const noexcept {
  std::uint8_t one = 0;
  for (int b = 0; b < 27; ++b) {
    const Voxel in_brick =
        origin + BoneVolume::kEdge * (Voxel(b % 3, b / 3 % 3, b / 9) - Voxel::Ones());
    const std::uint8_t label =
        labels_[static_cast<std::size_t>(volume.address(in_brick) / BoneVolume::kBrickVoxels)];
    if (label == kMixed || (one != 0 && label != 0 && label != one)) {
      return true;
    }
    one = std::max(one, label);
  }
  return false;
}

LabelMix::Other LabelMix::around(const BoneVolume& volume, const CellField& field,
                                 const Voxel& origin, const Voxel& of_brick,
                                 std::uint8_t own) noexcept {
  constexpr std::array<int, 4> kWeights{1, 3, 3, 1};
  std::array<int, 256> weights{};
  int all = 0;
  for (int n = 0; n < 64; ++n) {
    const Voxel step(n % 4, n / 4 % 4, n / 16);
    const Voxel voxel = of_brick + step - Voxel::Ones();
    if (field.is_filled(voxel)) {
      const int weight = kWeights[static_cast<std::size_t>(step.x())] *
                         kWeights[static_cast<std::size_t>(step.y())] *
                         kWeights[static_cast<std::size_t>(step.z())];
      weights[volume.label(Voxel(origin + voxel))] += weight;
      all += weight;
    }
  }
  const int mine = std::exchange(weights[own], 0);
  const auto most = std::max_element(weights.begin(), weights.end());
  if (all == 0 || *most == 0) {
    return {};
  }
  return {static_cast<std::uint8_t>(most - weights.begin()),
          static_cast<std::uint8_t>(255 * *most / (mine + *most))};
}

}  // namespace haptrial::bone
