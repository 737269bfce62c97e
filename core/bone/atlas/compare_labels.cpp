#include "core/bone/atlas/compare_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/bone/atlas/structure_masks.h"

namespace haptrial::bone {
namespace {

std::size_t label_of(const BoneModel& model, const std::string& name) {
  const auto found = std::ranges::find(model.structures, name, &Structure::name);
  return found == model.structures.end()
             ? 0
             : static_cast<std::size_t>(found - model.structures.begin());
}

/// The nearest voxel along an axis; -1 outside.
int nearest(const geometry::VoxelGrid& grid, int axis, double place) {
  const auto i = static_cast<int>(std::lround((place - grid.origin[axis]) / grid.spacing));
  return i >= 0 && i < grid.size[static_cast<std::size_t>(axis)] ? i : -1;
}

/// `label` where the truth has its structure, at the voxels of a grid.
std::vector<std::uint8_t> sampled(const BoneModel& truth, std::size_t of, std::uint8_t label,
                                  const geometry::VoxelGrid& grid) {
  std::vector<std::uint8_t> labels;
  labels.reserve(grid.count());
  for (int k = 0; k < grid.size[2]; ++k) {
    const int z = nearest(truth.grid, 2, grid.coordinate(2, k));
    for (int j = 0; j < grid.size[1]; ++j) {
      const int y = nearest(truth.grid, 1, grid.coordinate(1, j));
      for (int i = 0; i < grid.size[0]; ++i) {
        const int x = nearest(truth.grid, 0, grid.coordinate(0, i));
        const bool in = x >= 0 && y >= 0 && z >= 0 && truth.labels[truth.grid.index(x, y, z)] == of;
        labels.push_back(in ? label : 0);
      }
    }
  }
  return labels;
}

bool is_in(const BoneModel& mask, int i, int j, int k) {
  return mask.grid.contains({i, j, k}) &&
         mask.labels[mask.grid.index(i, j, k)] == StructureMasks::kIn;
}

/// Voxels with a face towards one that is not in the mask.
std::vector<bool> surface_of(const BoneModel& mask) {
  std::vector<bool> surface;
  surface.reserve(mask.labels.size());
  for (int k = 0; k < mask.grid.size[2]; ++k) {
    for (int j = 0; j < mask.grid.size[1]; ++j) {
      for (int i = 0; i < mask.grid.size[0]; ++i) {
        surface.push_back(is_in(mask, i, j, k) &&
                          !(is_in(mask, i - 1, j, k) && is_in(mask, i + 1, j, k) &&
                            is_in(mask, i, j - 1, k) && is_in(mask, i, j + 1, k) &&
                            is_in(mask, i, j, k - 1) && is_in(mask, i, j, k + 1)));
      }
    }
  }
  return surface;
}

struct Sum {
  double total{0.0};
  std::size_t count{0};
};

Sum distances_between(const StructureMasks& masks, const std::vector<bool>& from,
                      const std::vector<bool>& to) {
  const std::vector<float> away = distances_to(mask_like(masks, to), StructureMasks::kIn);
  Sum sum;
  for (std::size_t at = 0; at < away.size(); ++at) {
    if (from[at]) {
      sum.total += static_cast<double>(away[at]);
      ++sum.count;
    }
  }
  return sum;
}

std::optional<double> surface_distance(const StructureMasks& masks) {
  const std::array surfaces{surface_of(masks.fields[0]), surface_of(masks.fields[1])};
  const Sum there = distances_between(masks, surfaces[0], surfaces[1]);
  const Sum back = distances_between(masks, surfaces[1], surfaces[0]);
  if (there.count == 0 || back.count == 0) {
    return std::nullopt;
  }
  const double mean = (there.total + back.total) / static_cast<double>(there.count + back.count);
  return std::isfinite(mean) ? std::optional(mean) : std::nullopt;
}

double share_held(const StructureMasks& masks, double margin) {
  const std::vector<float> away = distances_to(masks.fields[0], StructureMasks::kIn);
  const std::vector<std::uint8_t>& truth = masks.fields[1].labels;
  std::size_t all = 0;
  std::size_t held = 0;
  for (std::size_t at = 0; at < away.size(); ++at) {
    const bool in = truth[at] == StructureMasks::kIn;
    all += in ? 1 : 0;
    held += in && static_cast<double>(away[at]) <= margin + 1e-9 ? 1 : 0;
  }
  return static_cast<double>(held) / static_cast<double>(all);
}

}  // namespace

std::optional<LabelMatch> compare_label(const BoneModel& model, std::uint8_t label,
                                        const BoneModel& truth, std::optional<double> margin) {
  const std::size_t of = label_of(truth, model.structures[label].name);
  const std::vector<std::uint8_t> there = sampled(truth, of, label, model.grid);
  if (of == 0 || std::ranges::find(there, label) == there.end()) {
    return std::nullopt;
  }
  const std::array<std::span<const std::uint8_t>, 2> fields{model.labels, there};
  const StructureMasks masks = masks_of(model.grid, fields, label);
  std::size_t both = 0;
  std::size_t sum = 0;
  for (std::size_t at = 0; at < masks.grid.count(); ++at) {
    const bool in_one = masks.fields[0].labels[at] == StructureMasks::kIn;
    const bool in_other = masks.fields[1].labels[at] == StructureMasks::kIn;
    both += in_one && in_other ? 1 : 0;
    sum += (in_one ? 1U : 0U) + (in_other ? 1U : 0U);
  }
  LabelMatch match;
  match.dice = 2.0 * static_cast<double>(both) / static_cast<double>(sum);
  match.distance = surface_distance(masks);
  if (margin) {
    match.held = share_held(masks, *margin);
  }
  return match;
}

}  // namespace haptrial::bone
