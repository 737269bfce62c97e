#include "core/bone/atlas/fuse_labels.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/parallel.h"
#include "core/bone/atlas/register_ears.h"
#include "core/bone/atlas/structure_masks.h"

namespace haptrial::bone {
namespace {

constexpr double kShare = 0.95;
constexpr double kCut = 1e-3;     // an ear that is farther off counts as much [m]
constexpr double kCutVoxels = 2;  // the least cut

using Field = std::vector<float>;  // of the voxels of a part

/// Distance to the structure, negative inside, cut off; 0 where the ear is unknown [m].
Field signed_distances(const BoneModel& mask) {
  const auto cut = static_cast<float>(std::max(kCut, kCutVoxels * mask.grid.spacing));
  Field field = distances_to(mask, StructureMasks::kIn);
  const Field inside = distances_to(mask, StructureMasks::kOut);
  for (std::size_t at = 0; at < field.size(); ++at) {
    const bool known = mask.labels[at] != StructureMasks::kUnknown;
    field[at] = known ? std::clamp(field[at] - inside[at], -cut, cut) : 0.0F;
  }
  return field;
}

Field sum_of(const std::vector<Field>& fields) {
  Field sum(fields.front().size(), 0.0F);
  for (const Field& field : fields) {
    std::ranges::transform(sum, field, sum.begin(), std::plus<>());
  }
  return sum;
}

/// How many ears reach each voxel.
std::vector<int> ears_at(const StructureMasks& masks) {
  std::vector<int> ears(masks.grid.count(), 0);
  for (const BoneModel& field : masks.fields) {
    for (std::size_t at = 0; at < ears.size(); ++at) {
      ears[at] += field.labels[at] != StructureMasks::kUnknown ? 1 : 0;
    }
  }
  return ears;
}

/// How far the voxels of one ear's structure lie outside of the one that the others give, where
/// others reach.
Field distances_from_others(const StructureMasks& masks, const Field& own, const Field& sum,
                            const std::vector<int>& ears, std::size_t ear) {
  std::vector<bool> in(sum.size());
  for (std::size_t at = 0; at < sum.size(); ++at) {
    in[at] = sum[at] - own[at] < 0.0F;
  }
  const Field away = distances_to(mask_like(masks, in), StructureMasks::kIn);
  Field kept;
  for (std::size_t at = 0; at < away.size(); ++at) {
    if (masks.fields[ear].labels[at] == StructureMasks::kIn && ears[at] > 1) {
      kept.push_back(away[at]);
    }
  }
  return kept;
}

std::optional<double> margin_of(const StructureMasks& masks, const std::vector<Field>& fields,
                                const Field& sum, const std::vector<int>& ears, int threads) {
  std::vector<Field> away(fields.size());
  parallel_for(fields.size(), threads, [&](std::size_t ear) {
    away[ear] = distances_from_others(masks, fields[ear], sum, ears, ear);
  });
  Field all;
  for (const Field& one : away) {
    all.insert(all.end(), one.begin(), one.end());
  }
  if (all.empty()) {
    return std::nullopt;
  }
  const auto rank = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(all.size() - 1));
  std::ranges::nth_element(all, all.begin() + rank);
  const auto margin = static_cast<double>(all[static_cast<std::size_t>(rank)]);
  return std::isfinite(margin) ? std::optional(margin) : std::nullopt;
}

/// Labels and mean distances of the structures that lead so far.
struct Leaders {
  std::vector<std::uint8_t> labels;
  Field distances;
};

void challenge(const StructureMasks& masks, const Field& mean, std::uint8_t label,
               const geometry::VoxelGrid& grid, Leaders& leaders) {
  std::size_t from = 0;
  for (int k = 0; k < masks.grid.size[2]; ++k) {
    for (int j = 0; j < masks.grid.size[1]; ++j) {
      const std::size_t row = grid.index(masks.low.x(), masks.low.y() + j, masks.low.z() + k);
      for (std::size_t to = row; to < row + static_cast<std::size_t>(masks.grid.size[0]);
           ++to, ++from) {
        if (mean[from] < leaders.distances[to]) {
          leaders.distances[to] = mean[from];
          leaders.labels[to] = label;
        }
      }
    }
  }
}

/// The fields of the ears that have a label at all.
std::vector<std::span<const std::uint8_t>> ears_with(
    std::span<const std::vector<std::uint8_t>> ears, std::uint8_t label) {
  std::vector<std::span<const std::uint8_t>> having;
  for (const auto& ear : ears) {
    if (std::ranges::find(ear, label) != ear.end()) {
      having.emplace_back(ear);
    }
  }
  return having;
}

/// Whether a voxel of the bone may become of a structure.
bool may_take(const BoneModel& model, std::size_t at, const Structure& structure) {
  constexpr float kDense = 0.5F;
  const std::uint8_t label = model.labels[at];
  if (label == 0) {
    return true;
  }
  const bool dense = model.density.empty() || model.density[at] >= kDense;
  return model.structures[label].name == kPlainBone && (looks_like_bone(structure) || !dense);
}

void take_labels(const Leaders& leaders, BoneModel& model, std::vector<CarriedStructure>& carried) {
  std::vector<std::size_t> counts(model.structures.size(), 0);
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    const std::uint8_t label = leaders.labels[at];
    if (label == 0 || !may_take(model, at, model.structures[label])) {
      continue;
    }
    model.labels[at] = label;
    ++counts[label];
    if (!model.density.empty()) {
      model.density[at] = 1.0F;
    }
  }
  for (CarriedStructure& one : carried) {
    one.voxels = counts[one.label];
  }
}

}  // namespace

std::vector<CarriedStructure> fuse_labels(std::span<const std::vector<std::uint8_t>> ears,
                                          BoneModel& model, int threads,
                                          const geometry::WorkReport& report) {
  threads = threads_or_all(threads);
  Leaders leaders{std::vector<std::uint8_t>(model.labels.size(), 0),
                  Field(model.labels.size(), 0.0F)};
  std::vector<CarriedStructure> carried;
  for (std::size_t number = 1; number < model.structures.size(); ++number) {
    geometry::report_share(
        report, static_cast<double>(number) / static_cast<double>(model.structures.size()));
    const auto label = static_cast<std::uint8_t>(number);
    const auto having = ears_with(ears, label);
    if (having.empty() || model.structures[number].name == kPlainBone) {
      continue;
    }
    const StructureMasks masks = masks_of(model.grid, having, label);
    std::vector<Field> fields(having.size());
    parallel_for(fields.size(), threads,
                 [&](std::size_t ear) { fields[ear] = signed_distances(masks.fields[ear]); });
    Field mean = sum_of(fields);
    const std::vector<int> reaching = ears_at(masks);
    carried.push_back({label, 0, margin_of(masks, fields, mean, reaching, threads)});
    for (std::size_t at = 0; at < mean.size(); ++at) {
      mean[at] /= static_cast<float>(std::max(reaching[at], 1));
    }
    challenge(masks, mean, label, model.grid, leaders);
  }
  take_labels(leaders, model, carried);
  return carried;
}

}  // namespace haptrial::bone
