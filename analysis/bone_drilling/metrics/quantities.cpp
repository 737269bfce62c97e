#include "analysis/bone_drilling/metrics/quantities.h"

#include <algorithm>

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

bool is_quantity(std::string_view name) {
  const std::vector<std::string> names = quantity_names();
  return (name.starts_with("bone_left_") && name.ends_with("_mm")) ||
         std::ranges::find(names, name) != names.end();
}

}  // namespace haptrial::analysis::drilling
