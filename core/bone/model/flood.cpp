#include "core/bone/model/flood.h"

#include <algorithm>
#include <bit>

namespace haptrial::bone {
namespace {

using Bits = std::array<std::uint64_t, 8>;

constexpr std::uint64_t kLowX = 0x0101010101010101U;   // the voxels with x = 0 of a layer
constexpr std::uint64_t kHighX = 0x8080808080808080U;  // with x = 7

/// Steps along x and y within a layer.
std::uint64_t spread(std::uint64_t layer) {
  return layer | ((layer & ~kHighX) << 1) | ((layer & ~kLowX) >> 1) | (layer << 8) | (layer >> 8);
}

/// Everything in `held` that hangs together with `part`, which lies in it.
void fill(Bits& part, const Bits& held) {
  bool grew = true;
  const auto grow = [&](std::size_t z, std::uint64_t from) {
    std::uint64_t now = part[z] | (from & held[z]);
    for (std::uint64_t next = spread(now) & held[z]; next != now; next = spread(now) & held[z]) {
      now = next;
    }
    grew = grew || now != part[z];
    part[z] = now;
  };
  while (grew) {
    grew = false;
    for (std::size_t z = 0; z < 8; ++z) {
      grow(z, z > 0 ? part[z - 1] : 0);
    }
    for (std::size_t z = 8; z-- > 0;) {
      grow(z, z < 7 ? part[z + 1] : 0);
    }
  }
}

/// The voxels of a brick that lie on its side across an axis, a bit each by the other two axes.
std::uint64_t face(const Bits& bits, int axis, bool high) {
  if (axis == 2) {
    return bits[high ? 7 : 0];
  }
  std::uint64_t all = 0;
  for (std::size_t z = 0; z < 8; ++z) {
    std::uint64_t row = 0;
    if (axis == 1) {
      row = high ? bits[z] >> 56 : bits[z] & 0xFF;
    } else {
      // Eight bits, eight places apart, gathered in the highest byte of a product.
      row = (((high ? bits[z] >> 7 : bits[z]) & kLowX) * 0x0102040810204080U) >> 56;
    }
    all |= row << (8 * z);
  }
  return all;
}

std::size_t count(const Bits& bits) {
  std::size_t sum = 0;
  for (const std::uint64_t layer : bits) {
    sum += static_cast<std::size_t>(std::popcount(layer));
  }
  return sum;
}

}  // namespace

void Flood::look(const BoneVolume& volume, const Occupancy& occupancy) {
  clusters_.clear();
  parent_.clear();
  first_.assign(static_cast<std::size_t>(volume.bricks()) + 1, 0);
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    first_[static_cast<std::size_t>(brick)] = static_cast<std::int32_t>(clusters_.size());
    Bits held;
    for (int z = 0; z < BoneVolume::kEdge; ++z) {
      held[static_cast<std::size_t>(z)] = occupancy.layer(brick, z);
    }
    label_brick(brick, held);
  }
  first_.back() = static_cast<std::int32_t>(clusters_.size());
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    for (int axis = 0; axis < 3; ++axis) {
      const Voxel beside = volume.brick_origin(brick) + BoneVolume::kEdge * Voxel::Unit(axis);
      if (const std::int32_t other = volume.address(beside) / BoneVolume::kBrickVoxels;
          other != 0) {
        unite(brick, other, axis);
      }
    }
  }
  number_parts();
}

void Flood::label_brick(std::int32_t brick, const Bits& held) {
  Bits rest = held;
  for (std::size_t z = 0; z < 8; ++z) {
    while (rest[z] != 0) {
      Bits part{};
      part[z] = rest[z] & (~rest[z] + 1);  // the lowest bit
      fill(part, rest);
      for (std::size_t i = 0; i < 8; ++i) {
        rest[i] &= ~part[i];
      }
      parent_.push_back(static_cast<std::int32_t>(clusters_.size()));
      clusters_.push_back({part, brick});
    }
  }
}

/// Unites what meets between a brick and the next one along an axis. Clusters of a brick never
/// share a face's voxel, and at most 32 of them can have one.
void Flood::unite(std::int32_t brick, std::int32_t other, int axis) {
  std::array<std::pair<std::uint64_t, std::int32_t>, 64> beyond;
  std::size_t beyond_count = 0;
  const auto each = [&](std::int32_t of, bool high, auto&& use) {
    const auto at = static_cast<std::size_t>(of);
    for (std::int32_t c = first_[at]; c < first_[at + 1]; ++c) {
      const std::uint64_t side = face(clusters_[static_cast<std::size_t>(c)].bits, axis, high);
      if (side != 0) {
        use(side, c);
      }
    }
  };
  each(other, false, [&](std::uint64_t side, std::int32_t c) {
    beyond[beyond_count++] = {side, c};
  });
  each(brick, true, [&](std::uint64_t side, std::int32_t c) {
    for (std::size_t i = 0; i < beyond_count; ++i) {
      if ((side & beyond[i].first) != 0) {
        const std::int32_t a = root(c);
        const std::int32_t b = root(beyond[i].second);
        parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
    }
  });
}

std::int32_t Flood::root(std::int32_t cluster) noexcept {
  auto at = [this](std::int32_t c) -> std::int32_t& {
    return parent_[static_cast<std::size_t>(c)];
  };
  while (at(cluster) != cluster) {
    at(cluster) = at(at(cluster));
    cluster = at(cluster);
  }
  return cluster;
}

void Flood::number_parts() {
  part_.assign(clusters_.size(), 0);
  sizes_.clear();
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const auto top = static_cast<std::size_t>(root(static_cast<std::int32_t>(c)));
    if (top == c) {  // comes before all others of its part
      part_[c] = static_cast<std::int32_t>(sizes_.size());
      sizes_.push_back(0);
    }
    part_[c] = part_[top];
    sizes_[static_cast<std::size_t>(part_[c])] += count(clusters_[c].bits);
  }
  main_ = static_cast<std::size_t>(std::max_element(sizes_.begin(), sizes_.end()) - sizes_.begin());
}

std::vector<Part> Flood::collect(const BoneVolume& volume, const std::vector<bool>& wanted) const {
  std::vector<Part> parts(sizes_.size());
  for (std::size_t p = 0; p < sizes_.size(); ++p) {
    parts[p].reserve(wanted[p] ? sizes_[p] : 0);
  }
  for (std::size_t brick = 1; brick + 1 < first_.size(); ++brick) {
    const auto begin = static_cast<std::size_t>(first_[brick]);
    const auto end = static_cast<std::size_t>(first_[brick + 1]);
    for (std::size_t c = begin; c < end; ++c) {
      const std::int32_t part = part_[c];
      const auto same = [part](std::int32_t other) { return other == part; };
      if (!wanted[static_cast<std::size_t>(part)] ||
          std::any_of(part_.begin() + static_cast<std::ptrdiff_t>(begin),
                      part_.begin() + static_cast<std::ptrdiff_t>(c), same)) {
        continue;  // of those of a part in a brick, the first does it for all
      }
      for (std::size_t z = 0; z < 8; ++z) {
        std::uint64_t layer = 0;
        for (std::size_t other = c; other < end; ++other) {
          layer |= part_[other] == part ? clusters_[other].bits[z] : 0;
        }
        const auto first = static_cast<std::int32_t>(512 * brick + 64 * z);
        for (; layer != 0; layer &= layer - 1) {
          parts[static_cast<std::size_t>(part)].push_back(
              volume.voxel_at(first + std::countr_zero(layer)));
        }
      }
    }
  }
  std::erase_if(parts, [](const Part& part) { return part.empty(); });
  return parts;
}

std::vector<Part> Flood::loose(const BoneVolume& volume) const {
  if (sizes_.size() < 2) {
    return {};
  }
  std::vector<bool> wanted(sizes_.size(), true);
  wanted[main_] = false;
  return collect(volume, wanted);
}

Part Flood::part_of(const BoneVolume& volume, const Voxel& voxel) const {
  const std::int32_t address = volume.address(voxel);
  const auto brick = static_cast<std::size_t>(address / BoneVolume::kBrickVoxels);
  const int place = address % BoneVolume::kBrickVoxels;
  for (std::int32_t c = first_[brick]; c < first_[brick + 1]; ++c) {
    const auto cluster = static_cast<std::size_t>(c);
    const std::uint64_t layer = clusters_[cluster].bits[static_cast<std::size_t>(place / 64)];
    if (((layer >> (place % 64)) & 1U) != 0) {
      std::vector<bool> wanted(sizes_.size(), false);
      wanted[static_cast<std::size_t>(part_[cluster])] = true;
      return collect(volume, wanted).front();
    }
  }
  return {};
}

std::vector<Part> Flood::all(const BoneVolume& volume) const {
  std::vector<Part> parts = collect(volume, std::vector<bool>(sizes_.size(), true));
  if (!parts.empty()) {
    std::rotate(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(main_),
                parts.begin() + static_cast<std::ptrdiff_t>(main_) + 1);
  }
  return parts;
}

}  // namespace haptrial::bone
