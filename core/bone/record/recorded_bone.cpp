#include "core/bone/record/recorded_bone.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core/base/error.h"
#include "core/base/utf8.h"
#include "core/record/table/schema.h"

namespace haptrial::bone {
namespace {

constexpr std::int32_t kLongest = 8192;  // voxels along an axis
constexpr std::size_t kMostVoxels = std::size_t{1} << 31;

/// Whether two lists agree in what `key` gives of each row.
template <class Row, class Key>
bool same(const std::vector<Row>& a, const std::vector<Row>& b, const Key& key) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Row& x, const Row& y) { return key(x) == key(y); });
}

}  // namespace

bool same_bone(const record::BoneRecord& a, const record::BoneRecord& b) {
  return a.bone.size == b.bone.size && a.bone.origin == b.bone.origin &&
         a.bone.spacing == b.bone.spacing &&
         same(a.structures, b.structures,
              [](const auto& s) { return std::tuple(s.label, s.name, s.hardness, s.vital); }) &&
         same(a.runs, b.runs,
              [](const auto& r) { return std::tuple(r.first, r.count, r.label); }) &&
         same(a.densities, b.densities,
              [](const auto& d) { return std::tuple(d.voxel, d.density); });
}

record::BoneRecord record_of(const BoneModel& model, std::int32_t number) {
  record::BoneRecord record;
  record.bone = {number,
                 std::string(cut_text(model.name, record::kNameBytes)),
                 std::string(cut_text(model.source, record::kTextBytes)),
                 model.grid.size,
                 model.grid.origin,
                 model.grid.spacing};
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    const Structure& s = model.structures[label];
    record.structures.push_back({number, static_cast<std::int32_t>(label),
                                 std::string(cut_text(s.name, record::kNameBytes)), s.colour,
                                 s.hardness, s.vital});
  }
  for (std::size_t at = 0; at < model.labels.size();) {
    std::size_t end = at + 1;
    while (end < model.labels.size() && model.labels[end] == model.labels[at]) {
      ++end;
    }
    if (model.labels[at] != 0) {
      record.runs.push_back({number, at, static_cast<std::int32_t>(end - at), model.labels[at]});
    }
    at = end;
  }
  for (std::size_t at = 0; at < model.density.size(); ++at) {
    if (model.labels[at] != 0 && model.density[at] != 1.0F) {
      record.densities.push_back({number, at, model.density[at]});
    }
  }
  return record;
}

BoneModel bone_of(const record::BoneRecord& record) {
  BoneModel model;
  model.name = record.bone.name;
  model.source = record.bone.source;
  model.grid = {record.bone.size, record.bone.origin, record.bone.spacing};
  for (const std::int32_t size : record.bone.size) {
    if (size < 1 || size > kLongest) {
      throw std::invalid_argument(fmt::format("its grid has {} voxels along an axis", size));
    }
  }
  if (model.grid.count() > kMostVoxels) {
    throw std::invalid_argument(fmt::format("its grid has {} voxels", model.grid.count()));
  }
  const std::size_t count = model.grid.count();
  model.labels.assign(count, 0);
  model.structures.emplace_back();
  for (const record::StructureRow& row : record.structures) {
    if (row.label < 1 || row.label > 255) {
      throw std::invalid_argument(fmt::format("a structure has label {}", row.label));
    }
    const auto label = static_cast<std::size_t>(row.label);
    if (label >= model.structures.size()) {
      model.structures.resize(label + 1);
    }
    model.structures[label] = {row.name, row.colour, row.hardness, row.vital};
  }
  for (const record::BoneRunRow& run : record.runs) {
    if (run.count < 0 || run.first > count ||
        static_cast<std::uint64_t>(run.count) > count - run.first) {
      throw std::invalid_argument("voxels lie outside of its grid");
    }
    std::fill_n(model.labels.begin() + static_cast<std::ptrdiff_t>(run.first), run.count,
                run.label);
  }
  if (!record.densities.empty()) {
    model.density.resize(count);
    std::transform(model.labels.begin(), model.labels.end(), model.density.begin(),
                   [](std::uint8_t label) { return label != 0 ? 1.0F : 0.0F; });
    for (const record::BoneDensityRow& row : record.densities) {
      if (row.voxel >= count) {
        throw std::invalid_argument("a density lies outside of its grid");
      }
      model.density[static_cast<std::size_t>(row.voxel)] = row.density;
    }
  }
  check(model);
  return model;
}

BoneModel model_of(const record::BoneRecord& record) {
  try {
    return bone_of(record);
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("the bone of the session file is damaged: {}; choose an undamaged session file",
                    error.what()));
  }
}

}  // namespace haptrial::bone
