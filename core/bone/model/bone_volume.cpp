#include "core/bone/model/bone_volume.h"

#include <algorithm>

namespace haptrial::bone {
namespace {

constexpr int kEdge = BoneVolume::kEdge;

int place_in_brick(const Voxel& voxel) {
  return (voxel.x() % kEdge) + kEdge * ((voxel.y() % kEdge) + kEdge * (voxel.z() % kEdge));
}

bool lies_in(const geometry::VoxelGrid& grid, const Voxel& voxel) {
  const auto within = [](int i, int size) {
    return static_cast<unsigned>(i) < static_cast<unsigned>(size);
  };
  return within(voxel.x(), grid.size[0]) && within(voxel.y(), grid.size[1]) &&
         within(voxel.z(), grid.size[2]);
}

std::array<std::int32_t, 3> table_of(const geometry::VoxelGrid& grid) {
  std::array<std::int32_t, 3> size{};
  std::transform(grid.size.begin(), grid.size.end(), size.begin(),
                 [](std::int32_t voxels) { return (voxels + kEdge - 1) / kEdge; });
  return size;
}

std::size_t product(const std::array<std::int32_t, 3>& size) {
  return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
         static_cast<std::size_t>(size[2]);
}

}  // namespace

BoneVolume::BoneVolume(const BoneModel& model)
    : grid_(model.grid),
      table_size_(table_of(model.grid)),
      table_(product(table_size_), 0),
      origins_(1, Voxel::Zero()) {
  check(model);
  const auto mark = [&](const Voxel& voxel, std::size_t index) {
    if (model.labels[index] != 0) {
      table_[table_index(voxel)] = 1;
    }
  };
  geometry::visit_voxels(grid_, mark);
  make_room();
  if (!model.density.empty()) {
    originals_.assign(labels_.size(), 0);
  }
  const auto fill = [&](const Voxel& voxel, std::size_t index) {
    if (model.labels[index] != 0) {
      const std::int32_t at = address(voxel);
      densities_[at] = model.density.empty() ? 1.0F : model.density[index];
      if (densities_[at] > 0.0F) {
        flip(at);
      }
      labels_[static_cast<std::size_t>(at)] = model.labels[index];
      if (!originals_.empty()) {
        keep_original(at, densities_[at]);
      }
    }
  };
  geometry::visit_voxels(grid_, fill);
}

BoneVolume::BoneVolume(const BoneVolume& other, std::span<const Voxel> voxels)
    : grid_(other.grid_),
      table_size_(other.table_size_),
      table_(other.table_.size(), 0),
      origins_(1, Voxel::Zero()) {
  for (const Voxel& voxel : voxels) {
    if (other.address(voxel) != 0) {
      table_[table_index(voxel)] = 1;
    }
  }
  make_room();
  if (!other.originals_.empty()) {
    originals_.assign(labels_.size(), 0);
  }
  for (const Voxel& voxel : voxels) {
    if (const std::int32_t from = other.address(voxel); from != 0) {
      const auto at = static_cast<std::size_t>(address(voxel));
      labels_[at] = other.label(from);
      if (!originals_.empty()) {
        originals_[at] = other.originals_[static_cast<std::size_t>(from)];
      }
    }
  }
}

/// Numbers the places that are marked in the table, in its order, and makes their bricks.
void BoneVolume::make_room() {
  std::size_t place = 0;
  for (int k = 0; k < table_size_[2]; ++k) {
    for (int j = 0; j < table_size_[1]; ++j) {
      for (int i = 0; i < table_size_[0]; ++i, ++place) {
        if (table_[place] != 0) {
          table_[place] = static_cast<std::int32_t>(origins_.size());
          origins_.emplace_back(kEdge * i, kEdge * j, kEdge * k);
        }
      }
    }
  }
  const std::size_t addresses = origins_.size() * kBrickVoxels;
  densities_ = std::make_unique<float[]>(addresses);
  labels_.assign(addresses, 0);
  filled_.assign(addresses / 64, 0);
  holding_.assign(origins_.size(), 0);
  versions_ = std::make_unique<std::atomic<std::uint32_t>[]>(origins_.size());
}

std::size_t BoneVolume::table_index(const Voxel& voxel) const noexcept {
  const auto at = [](int i) { return static_cast<std::size_t>(i / kEdge); };
  return at(voxel.x()) +
         static_cast<std::size_t>(table_size_[0]) *
             (at(voxel.y()) + static_cast<std::size_t>(table_size_[1]) * at(voxel.z()));
}

std::int32_t BoneVolume::address(const Voxel& voxel) const noexcept {
  if (!lies_in(grid_, voxel)) {
    return 0;
  }
  const std::int32_t brick = table_[table_index(voxel)];
  return brick == 0 ? 0 : brick * kBrickVoxels + place_in_brick(voxel);
}

Voxel BoneVolume::voxel_at(std::int32_t address) const noexcept {
  const int place = address % kBrickVoxels;
  return brick_origin(address / kBrickVoxels) +
         Voxel(place % kEdge, place / kEdge % kEdge, place / (kEdge * kEdge));
}

double BoneVolume::amount() const noexcept {
  double sum = 0.0;
  for (std::int32_t at = kBrickVoxels; at < bricks() * kBrickVoxels; ++at) {
    sum += static_cast<double>(density(at));
  }
  return sum;
}

BoneVolume::View BoneVolume::view() const noexcept {
  return {grid_.size,       table_size_,    table_.data(),
          densities_.get(), filled_.data(), holding_.data()};
}

}  // namespace haptrial::bone
