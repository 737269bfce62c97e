#include "experiments/bone_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/record/schema.h"

namespace haptrial::experiments {
namespace {

/// At most so many bytes, cut between characters.
std::string cut(const std::string& text, std::size_t bytes) {
  std::size_t size = std::min(text.size(), bytes);
  while (size > 0 && size < text.size() &&
         (static_cast<unsigned char>(text[size]) & 0xC0u) == 0x80u) {
    --size;
  }
  return text.substr(0, size);
}

[[noreturn]] void damaged(const std::string& what) {
  throw InputError(
      fmt::format("the bone of the session file is damaged: {}; allowed: an undamaged one", what));
}

}  // namespace

record::BoneRecord record_of(const bone::BoneModel& model, std::int32_t number) {
  record::BoneRecord record;
  record.bone = {number,
                 cut(model.name, record::kNameBytes),
                 cut(model.source, record::kTextBytes),
                 model.grid.size,
                 model.grid.origin,
                 model.grid.spacing};
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    const bone::Structure& s = model.structures[label];
    record.structures.push_back({number, static_cast<std::int32_t>(label),
                                 cut(s.name, record::kNameBytes), s.colour, s.hardness, s.vital});
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

bone::BoneModel model_of(const record::BoneRecord& record) {
  bone::BoneModel model;
  model.name = record.bone.name;
  model.source = record.bone.source;
  model.grid = {record.bone.size, record.bone.origin, record.bone.spacing};
  constexpr std::int32_t kLongest = 8192;  // voxels along an axis
  for (const std::int32_t size : model.grid.size) {
    if (size < 1 || size > kLongest) {
      damaged(fmt::format("{} voxels along an axis", size));
    }
  }
  model.labels.assign(model.grid.count(), 0);
  for (const record::BoneRunRow& run : record.runs) {
    if (run.count < 1 || run.first > model.labels.size() ||
        static_cast<std::uint64_t>(run.count) > model.labels.size() - run.first) {
      damaged(fmt::format("voxels from {} on are outside of its grid", run.first));
    }
    std::fill_n(model.labels.begin() + static_cast<std::ptrdiff_t>(run.first), run.count,
                run.label);
  }
  if (!record.densities.empty()) {
    model.density.assign(model.labels.size(), 0.0F);
    std::transform(model.labels.begin(), model.labels.end(), model.density.begin(),
                   [](std::uint8_t label) { return label != 0 ? 1.0F : 0.0F; });
    for (const record::BoneDensityRow& row : record.densities) {
      if (row.voxel >= model.density.size()) {
        damaged(fmt::format("voxel {} is outside of its grid", row.voxel));
      }
      model.density[row.voxel] = row.density;
    }
  }
  model.structures.resize(1);
  for (const record::StructureRow& row : record.structures) {
    if (row.label < 1 || row.label > 255) {
      damaged(fmt::format("a structure has the label {}", row.label));
    }
    const auto label = static_cast<std::size_t>(row.label);
    model.structures.resize(std::max(model.structures.size(), label + 1));
    model.structures[label] = {row.name, row.colour, row.hardness, row.vital};
  }
  try {
    check(model);
  } catch (const std::invalid_argument& error) {
    damaged(error.what());
  }
  return model;
}

}  // namespace haptrial::experiments
