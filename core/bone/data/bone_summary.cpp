#include "core/bone/data/bone_summary.h"

#include <array>

namespace haptrial::bone {
namespace {

using geometry::VoxelGrid;

/// Calls visit(index) for the up to 26 neighbours.
template <class Visit>
void around(const VoxelGrid& grid, std::size_t index, Visit&& visit) {
  const Eigen::Vector3i middle = grid.voxel(index);
  const int i = middle.x(), j = middle.y(), k = middle.z();
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

/// A voxel near a face, from the voxel that the face belongs to and from the face's middle.
struct NearFace {
  Eigen::Vector3i voxel;
  Eigen::Vector3d place;
};

std::vector<NearFace> near_face(const Eigen::Vector3i& side) {
  constexpr double kReach = 1.6;
  std::vector<NearFace> near;
  for (int n = 0; n < 125; ++n) {
    const Eigen::Vector3i voxel(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2);
    const Eigen::Vector3d place = voxel.cast<double>() - 0.5 * side.cast<double>();
    if (place.norm() <= kReach) {
      near.push_back({voxel, place});
    }
  }
  return near;
}

/// Area in faces of voxels: the faces between voxels that hold something and such that do not, each
/// over |x| + |y| + |z| of the normal there. Beyond the grid is nothing.
double outside_of(const BoneModel& model) {
  const VoxelGrid& grid = model.grid;
  const auto full = [&](const Eigen::Vector3i& v) {
    return grid.contains(v) && model.labels[grid.index(v)] != 0;
  };
  double area = 0.0;
  for (int direction = 0; direction < 6; ++direction) {
    const Eigen::Vector3i side = (direction < 3 ? 1 : -1) * Eigen::Vector3i::Unit(direction % 3);
    const std::vector<NearFace> near = near_face(side);
    for (std::size_t at = 0; at < model.labels.size(); ++at) {
      if (model.labels[at] == 0) {
        continue;
      }
      const Eigen::Vector3i voxel = grid.voxel(at);
      if (full(voxel + side)) {
        continue;
      }
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      for (const NearFace& each : near) {
        if (full(voxel + each.voxel)) {
          normal -= each.place;
        }
      }
      area += normal.isZero() ? 1.0 : normal.norm() / normal.lpNorm<1>();
    }
  }
  return area;
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
    ++one.voxels;
    one.mean_density += model.density.empty() ? 1.0 : static_cast<double>(model.density[i]);
    one.box.extend(model.grid.centre(model.grid.voxel(i)));
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
  summary.surface = outside_of(model) * h * h;
  return summary;
}

}  // namespace haptrial::bone
