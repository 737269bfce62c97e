#include "core/bone/model/occupancy.h"

#include <bit>

namespace haptrial::bone {

void Occupancy::follow(const BoneVolume& volume, std::vector<Voxel>* changed,
                       std::vector<std::int32_t>* bricks) {
  constexpr int kWords = BoneVolume::kBrickVoxels / 64;
  bits_.resize(static_cast<std::size_t>(volume.bricks()) * kWords, 0);
  versions_.resize(static_cast<std::size_t>(volume.bricks()), 0);
  seen_.resize(static_cast<std::size_t>(volume.bricks()), false);
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    const auto at = static_cast<std::size_t>(brick);
    const std::uint32_t version = volume.version(brick);  // before the densities
    if (seen_[at] && versions_[at] == version) {
      continue;
    }
    seen_[at] = true;
    versions_[at] = version;
    if (bricks != nullptr) {
      bricks->push_back(brick);
    }
    for (int word = 0; word < kWords; ++word) {
      const std::int32_t first = brick * BoneVolume::kBrickVoxels + 64 * word;
      std::uint64_t now = 0;
      for (int bit = 0; bit < 64; ++bit) {
        now |= static_cast<std::uint64_t>(volume.density(first + bit) > 0.0F) << bit;
      }
      std::uint64_t& known = bits_[at * kWords + static_cast<std::size_t>(word)];
      for (std::uint64_t rest = changed != nullptr ? now ^ known : 0; rest != 0; rest &= rest - 1) {
        changed->push_back(volume.voxel_at(first + std::countr_zero(rest)));
      }
      count_ += static_cast<std::size_t>(std::popcount(now));
      count_ -= static_cast<std::size_t>(std::popcount(known));
      known = now;
    }
  }
}

}  // namespace haptrial::bone
