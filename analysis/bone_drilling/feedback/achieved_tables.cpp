#include "analysis/bone_drilling/feedback/achieved_tables.h"

#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr const char* kFragmentWords =
    "Gap and step are the error of the fragment against its planned pose, taken at the middle of "
    "the planned cut: along the cut's normal, above 0 where the slot stands open, and across it. "
    "Teeth are those beyond the cut, compared with where the plan has them. A screw holds with 2 "
    "mm "
    "of solid bone in its thread.";

}  // namespace

std::optional<double> achieved_value(const ProcedureSummary& summary, const std::string& column) {
  for (const AchievedFigure& figure : figures_of(summary.achieved)) {
    if (figure.column == column) {
      return figure.value;
    }
  }
  return std::nullopt;
}

std::optional<SafeRange> achieved_range(const Experts& experts, const std::string& column) {
  std::vector<double> values;
  for (const ProcedureSummary& summary : experts.summaries) {
    if (const auto value = achieved_value(summary, column)) {
      values.push_back(*value);
    }
  }
  return range_of(std::move(values));
}

std::string achieved_section(const Findings& f, const Experts& experts) {
  std::vector<std::vector<std::string>> rows;
  for (const AchievedFigure& figure : figures_of(f.summary.achieved)) {
    const auto range = achieved_range(experts, figure.column);
    if (!figure.value && !range) {
      continue;  // nobody came near this structure
    }
    rows.push_back({figure.title, figure.unit, number_text(figure.value),
                    range ? number_text(range->median) : "-",
                    range ? number_text(range->low) + " to " + number_text(range->high) : "-"});
  }
  const Achieved& achieved = f.summary.achieved;
  return heading("What was achieved") +
         (achieved.plan || achieved.fragment
              ? ""
              : paragraph("The definition plans no cavity ([cavity]), so nothing says what was to "
                          "be removed.")) +
         html_table({"", "unit", "value", "experts' median", "experts' range"}, rows) +
         (achieved.fragment ? paragraph(kFragmentWords) : "") +
         paragraph(
             "A voxel beside the plan is neither part of it nor beyond it. Bone left over a "
             "structure is the least distance from it to a removed voxel, up to 10 mm; 0: bare or "
             "opened. The path is that of the tip while the hand drives the tool.");
}

}  // namespace haptrial::analysis::drilling
