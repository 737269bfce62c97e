#include "analysis/bone_drilling/report/phase_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "analysis/bone_drilling/phases/phase_labels.h"
#include "analysis/bone_drilling/report/validity_table.h"
#include "analysis/bone_drilling/report/validity_words.h"
#include "analysis/statistics/design/interval_word.h"

namespace haptrial::analysis::drilling {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> all_phases(const ValidityResult& result) {
  std::vector<std::vector<PhaseSpan>> all;
  for (const ProcedureSummary& p : result.procedures) {
    if (!p.phases.empty()) {
      all.push_back(p.phases);
    }
  }
  return phases_in_order(all);
}

/// One row: means of each group in a quantity of every divided procedure.
template <class Value>
std::vector<std::string> phase_row(const ValidityResult& result, const std::string& title,
                                   const Value& value) {
  ValueTable table = table_of(result.validity, result.procedures);
  for (std::size_t i = 0; i < result.procedures.size(); ++i) {
    if (!result.procedures[i].phases.empty()) {
      table.rows[i].value = value(result.procedures[i].phases);
    }
  }
  std::vector<std::string> row{title};
  const auto means = group_values(table, result.validity.plan);
  for (std::size_t g = 0; g < result.validity.plan.groups.size(); ++g) {
    row.push_back(interval_word(means[g].participant_means));
  }
  return row;
}

/// The order in which phases began first, by how many procedures had it, the most frequent first.
Rows orders_of(const ValidityResult& result) {
  std::map<std::string, int> counts;
  for (const ProcedureSummary& p : result.procedures) {
    std::vector<std::string> names;
    for (const PhaseTime& each : phase_times(p.phases)) {
      names.push_back(each.phase);
    }
    counts[fmt::format("{}", fmt::join(names, ", "))] += names.empty() ? 0 : 1;
  }
  Rows rows;
  for (const auto& [order, count] : counts) {
    if (count > 0) {
      rows.push_back({order, std::to_string(count)});
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) {
    return counts[a.front()] > counts[b.front()];
  });
  return rows;
}

}  // namespace

bool is_divided(const ValidityResult& result) {
  return std::any_of(result.procedures.begin(), result.procedures.end(),
                     [](const ProcedureSummary& p) { return !p.phases.empty(); });
}

void add_phase_section(Document& document, const ValidityResult& result) {
  if (!is_divided(result)) {
    return;
  }
  std::vector<std::string> heading{"mean of participants' means [95 % CI]"};
  heading.insert(heading.end(), result.validity.plan.groups.begin(),
                 result.validity.plan.groups.end());
  Rows rows;
  for (const std::string& phase : all_phases(result)) {
    rows.push_back(
        phase_row(result, phase + ", time [s]",
                  [&](const std::vector<PhaseSpan>& spans) { return time_in(spans, phase); }));
  }
  rows.push_back(phase_row(result, "changes of the phase", [](const std::vector<PhaseSpan>& spans) {
    return static_cast<double>(phase_changes(spans));
  }));
  document.heading(result.validity.simulated ? "Phases (simulated)" : "Phases");
  document.paragraph(
      "A hidden Markov model (phases.json of the study) recognised them from the strokes: tool, "
      "depth, nearest structure, force, speed and view. It errs, by as much as haptrial bone "
      "phases said when it was learned. If it was learned from these same procedures it fits them "
      "better than others. Groups are not compared here.");
  document.table(heading, rows);
  document.table({"order in which phases began first", "procedures"}, orders_of(result));
}

std::string phases_csv(std::span<const ProcedureSummary> procedures) {
  PhaseLabels labels;
  for (const ProcedureSummary& p : procedures) {
    if (!p.phases.empty()) {
      labels[{p.session, p.number}] = p.phases;
    }
  }
  return phase_labels_csv(labels);
}

}  // namespace haptrial::analysis::drilling
