#include "analysis/bone_drilling/report/achieved_section.h"

#include <fmt/format.h>

#include "analysis/bone_drilling/report/validity_table.h"
#include "analysis/bone_drilling/report/validity_words.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr const char* kCavity =
    "The plan is the cavity of the definition as far as the smallest burr reaches; a voxel beside "
    "it is neither planned nor beyond it.";
constexpr const char* kOsteotomy =
    "The plan is the osteotomy of the definition. Gap and step are the error of the fragment at "
    "the middle of the planned cut, along its normal (above 0: open) and across it; a screw holds "
    "with 2 mm of solid bone in its thread.";

ValueTable column_values(const ValidityResult& result, const std::string& column) {
  ValueTable table = table_of(result.validity, result.procedures);
  for (std::size_t i = 0; i < result.procedures.size(); ++i) {
    for (const AchievedFigure& figure : figures_of(result.procedures[i].achieved)) {
      if (figure.column == column) {
        table.rows[i].value = figure.value;
      }
    }
  }
  return table;
}

}  // namespace

void add_achieved_section(Document& document, const ValidityResult& result) {
  const std::vector<std::string>& groups = result.validity.plan.groups;
  std::vector<std::string> heading{"mean of participants' means [95 % CI]"};
  heading.insert(heading.end(), groups.begin(), groups.end());
  std::vector<std::vector<std::string>> rows;
  for (const AchievedFigure& figure : figures_of(result.procedures.front().achieved)) {
    std::vector<std::string> row{fmt::format("{} [{}]", figure.title, figure.unit)};
    const auto means = group_values(column_values(result, figure.column), result.validity.plan);
    bool any = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      any = any || means[g].procedures > 0;
      row.push_back(mean_word(means[g]));
    }
    if (any) {  // else nobody came near this structure
      rows.push_back(std::move(row));
    }
  }
  document.heading(result.validity.simulated ? "What was achieved (simulated)"
                                             : "What was achieved");
  document.paragraph(
      std::string(result.procedures.front().achieved.fragment ? kOsteotomy : kCavity) +
      " Bone left over a structure is the least "
      "distance from it to a removed voxel, up to 10 mm. Groups are not compared here.");
  document.table(heading, rows);
}

}  // namespace haptrial::analysis::drilling
