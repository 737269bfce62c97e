#include "experiments/bone_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "analysis/drilling/procedure.h"
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
  try {
    return analysis::drilling::bone_of(record);
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("the bone of the session file is damaged: {}; choose an undamaged session file",
                    error.what()));
  }
}

}  // namespace haptrial::experiments
