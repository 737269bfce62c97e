#include "core/bone/data/bone_summary.h"

#include <array>
#include <cmath>

namespace haptrial::bone {
namespace {

using geometry::VoxelGrid;

/// Voxel numbers i, j, k of an index.
std::array<std::int32_t, 3> place_of(const VoxelGrid& grid, std::size_t index) {
  const auto nx = static_cast<std::size_t>(grid.size[0]);
  const auto ny = static_cast<std::size_t>(grid.size[1]);
  return {static_cast<std::int32_t>(index % nx), static_cast<std::int32_t>(index / nx % ny),
          static_cast<std::int32_t>(index / nx / ny)};
}

/// Calls visit(index) for the up to 26 neighbours.
template <class Visit>
void around(const VoxelGrid& grid, std::size_t index, Visit&& visit) {
  const auto [i, j, k] = place_of(grid, index);
  for (std::int32_t z = std::max(0, k - 1); z <= std::min(grid.size[2] - 1, k + 1); ++z) {
    for (std::int32_t y = std::max(0, j - 1); y <= std::min(grid.size[1] - 1, j + 1); ++y) {
      for (std::int32_t x = std::max(0, i - 1); x <= std::min(grid.size[0] - 1, i + 1); ++x) {
        visit(grid.index(x, y, z));
      }
    }
  }
}

/// Pieces of equal labels, by label.
std::array<std::size_t, 256> count_pieces(const BoneModel& model) {
  std::array<std::size_t, 256> pieces{};
  std::vector<bool> seen(model.labels.size());
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < model.labels.size(); ++start) {
    const std::uint8_t label = model.labels[start];
    if (label == 0 || seen[start]) {
      continue;
    }
    ++pieces[label];
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t voxel = open.back();
      open.pop_back();
      around(model.grid, voxel, [&](std::size_t next) {
        if (!seen[next] && model.labels[next] == label) {
          seen[next] = true;
          open.push_back(next);
        }
      });
    }
  }
  return pieces;
}

/// Faces between voxels that hold something and such that do not; beyond the grid is nothing.
std::size_t count_faces(const BoneModel& model) {
  std::size_t faces = 0;
  const VoxelGrid& grid = model.grid;
  const auto full = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    return i >= 0 && j >= 0 && k >= 0 && i < grid.size[0] && j < grid.size[1] && k < grid.size[2] &&
           model.labels[grid.index(i, j, k)] != 0;
  };
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        if (!full(i, j, k)) {
          continue;
        }
        faces += !full(i - 1, j, k);
        faces += !full(i + 1, j, k);
        faces += !full(i, j - 1, k);
        faces += !full(i, j + 1, k);
        faces += !full(i, j, k - 1);
        faces += !full(i, j, k + 1);
      }
    }
  }
  return faces;
}

}  // namespace

BoneSummary summary_of(const BoneModel& model) {
  check(model);
  const double h = model.grid.spacing;
  std::array<StructureSummary, 256> all{};
  for (StructureSummary& one : all) {
    one.box.setEmpty();
  }
  for (std::size_t i = 0; i < model.labels.size(); ++i) {
    if (model.labels[i] == 0) {
      continue;
    }
    StructureSummary& one = all[model.labels[i]];
    const auto [x, y, z] = place_of(model.grid, i);
    ++one.voxels;
    one.mean_density += model.density.empty() ? 1.0 : static_cast<double>(model.density[i]);
    one.box.extend(model.grid.centre(x, y, z));
  }
  const std::array<std::size_t, 256> pieces = count_pieces(model);
  BoneSummary summary;
  for (std::size_t label = 1; label < all.size(); ++label) {
    StructureSummary& one = all[label];
    if (one.voxels == 0) {
      continue;
    }
    one.label = static_cast<std::uint8_t>(label);
    one.volume = static_cast<double>(one.voxels) * h * h * h;
    one.mean_density /= static_cast<double>(one.voxels);
    one.pieces = pieces[label];
    summary.voxels += one.voxels;
    summary.volume += one.volume;
    summary.box.extend(one.box);
    summary.structures.push_back(one);
  }
  summary.surface = static_cast<double>(count_faces(model)) * h * h / 1.5;
  return summary;
}

}  // namespace haptrial::bone
