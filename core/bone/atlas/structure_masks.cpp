#include "core/bone/atlas/structure_masks.h"

#include <algorithm>
#include <limits>

#include "core/bone/model/distance_field.h"

namespace haptrial::bone {
namespace {

constexpr double kReach = 20e-3;       // [m]
constexpr double kMostVoxels = 250.0;  // that a distance field reaches

Eigen::AlignedBox3i box_of(const geometry::VoxelGrid& grid, std::span<const std::uint8_t> labels,
                           std::uint8_t label) {
  Eigen::AlignedBox3i box;
  geometry::visit_voxels(grid, [&](const Voxel& voxel, std::size_t at) {
    if (labels[at] == label) {
      box.extend(voxel);
    }
  });
  return box;
}

BoneModel empty_mask(const geometry::VoxelGrid& grid) {
  BoneModel mask;
  mask.grid = grid;
  mask.labels.assign(grid.count(), StructureMasks::kOut);
  mask.structures.resize(4);
  mask.structures[StructureMasks::kIn].name = "in";
  mask.structures[StructureMasks::kOut].name = "out";
  mask.structures[StructureMasks::kUnknown].name = "unknown";
  return mask;
}

}  // namespace

StructureMasks masks_of(const geometry::VoxelGrid& grid,
                        std::span<const std::span<const std::uint8_t>> fields, std::uint8_t label) {
  StructureMasks masks;
  Eigen::AlignedBox3i box;
  for (const auto& labels : fields) {
    box.extend(box_of(grid, labels, label));
  }
  if (box.isEmpty()) {
    return masks;
  }
  const Voxel last = grid.last();
  masks.low = (box.min() - Voxel::Ones()).cwiseMax(0);
  const Voxel extent = (box.max() + Voxel::Ones()).cwiseMin(last) - masks.low + Voxel::Ones();
  masks.grid = {{extent.x(), extent.y(), extent.z()}, grid.centre(masks.low), grid.spacing};
  for (const auto& labels : fields) {
    BoneModel mask = empty_mask(masks.grid);
    auto to = mask.labels.begin();
    for (int k = 0; k < extent.z(); ++k) {
      for (int j = 0; j < extent.y(); ++j, to += extent.x()) {
        const std::size_t from = grid.index(masks.low.x(), masks.low.y() + j, masks.low.z() + k);
        std::ranges::transform(labels.subspan(from, static_cast<std::size_t>(extent.x())), to,
                               [label](std::uint8_t one) {
                                 return one == label        ? StructureMasks::kIn
                                        : one == kBeyondEar ? StructureMasks::kUnknown
                                                            : StructureMasks::kOut;
                               });
      }
    }
    masks.fields.push_back(std::move(mask));
  }
  return masks;
}

BoneModel mask_like(const StructureMasks& masks, const std::vector<bool>& in) {
  BoneModel mask = empty_mask(masks.grid);
  std::ranges::transform(in, mask.labels.begin(),
                         [](bool one) { return one ? StructureMasks::kIn : StructureMasks::kOut; });
  return mask;
}

std::vector<float> distances_to(const BoneModel& mask, std::uint8_t label) {
  const double reach = std::min(kReach, kMostVoxels * mask.grid.spacing);
  std::vector<bool> set(label + 1U, false);
  set[label] = true;
  const DistanceField field(mask, set, reach);
  std::vector<float> distances;
  distances.reserve(mask.grid.count());
  geometry::visit_voxels(mask.grid, [&](const Voxel& voxel, std::size_t) {
    distances.push_back(
        static_cast<float>(field.at(voxel).value_or(std::numeric_limits<double>::infinity())));
  });
  return distances;
}

}  // namespace haptrial::bone
