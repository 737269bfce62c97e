#include "analysis/bone_drilling/metrics/quantities.h"

#include <algorithm>
#include <stdexcept>

#include "analysis/bone_drilling/metrics/metrics.h"

namespace haptrial::analysis::drilling {

std::vector<std::string> quantity_names() {
  ProcedureSummary cavity, osteotomy;
  osteotomy.achieved.fragment.emplace();
  std::vector<std::string> names = quantity_names(cavity);
  for (const std::string& name : quantity_names(osteotomy)) {
    if (std::ranges::find(names, name) == names.end()) {
      names.push_back(name);
    }
  }
  names.emplace_back("bone_left_STRUCTURE_mm");
  return names;
}

std::vector<std::string> quantity_names_on(const bone::BoneModel& bone, bool osteotomy) {
  ProcedureSummary summary;
  summary.achieved.left = untouched(bone);
  if (osteotomy) {
    summary.achieved.fragment.emplace();
  }
  return quantity_names(summary);
}

bool is_bone_left(std::string_view name) {
  return name.starts_with("bone_left_") && name.ends_with("_mm");
}

bool is_quantity(std::string_view name) {
  const std::vector<std::string> names = quantity_names();
  return is_bone_left(name) || std::ranges::find(names, name) != names.end();
}

QuantityWords words_of_quantity(std::string_view name) {
  for (const MetricKind& kind : metric_kinds()) {
    if (kind.name == name) {
      return {kind.title, kind.unit};
    }
  }
  Achieved cavity, osteotomy;
  osteotomy.fragment.emplace();
  for (const Achieved& achieved : {cavity, osteotomy}) {
    for (const AchievedFigure& figure : figures_of(achieved)) {
      if (figure.column == name) {
        return {figure.title, figure.unit};
      }
    }
  }
  if (!is_quantity(name)) {
    throw std::invalid_argument("words_of_quantity: no quantity " + std::string(name));
  }
  constexpr std::string_view kBefore = "bone_left_", kBehind = "_mm";
  std::string structure(name.substr(kBefore.size(), name.size() - kBefore.size() - kBehind.size()));
  std::ranges::replace(structure, '_', ' ');
  return {"bone left over " + structure, "mm"};
}

}  // namespace haptrial::analysis::drilling
