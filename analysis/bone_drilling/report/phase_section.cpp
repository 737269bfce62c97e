#include "analysis/bone_drilling/report/phase_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "analysis/bone_drilling/phases/phase_labels.h"
#include "analysis/bone_drilling/report/validity_table.h"

namespace haptrial::analysis::drilling {
namespace {

std::vector<std::string> all_phases(const ValidityResult& result) {
  std::vector<std::vector<PhaseSpan>> all;
  for (const ProcedureSummary& p : result.procedures) {
    if (!p.phases.empty()) {
      all.push_back(p.phases);
    }
  }
  return phases_in_order(all);
}

/// A row for each group: its mean in a quantity of every divided procedure.
template <class Value>
void add_means(FindingTable& rows, const ValidityResult& result, const Finding& label,
               const std::string& unit, const Value& value) {
  ValueTable table = table_of(result.validity, result.procedures);
  for (std::size_t i = 0; i < result.procedures.size(); ++i) {
    if (!result.procedures[i].phases.empty()) {
      table.rows[i].value = value(result.procedures[i].phases);
    }
  }
  for (const GroupValues& group : group_values(table, result.validity.plan)) {
    Finding mean{.name = "mean",
                 .title = "mean of participants' means",
                 .unit = unit,
                 .form = JsonForm::kEstimate};
    if (group.participant_means) {
      mean.value = group.participant_means->mean;
      mean.low = group.participant_means->low;
      mean.high = group.participant_means->high;
    } else if (group.mean) {
      mean.value = *group.mean;
    } else {
      mean.why_not = group.participant_means.because();
    }
    rows.rows.push_back({label, plain_finding("group", "group", group.group), mean});
  }
}

/// The order in which phases began first, by how many procedures had it, the most frequent first.
std::vector<FindingRow> orders_of(const ValidityResult& result) {
  std::map<std::string, int> counts;
  for (const ProcedureSummary& p : result.procedures) {
    std::vector<std::string> names;
    for (const PhaseTime& each : phase_times(p.phases)) {
      names.push_back(each.phase);
    }
    if (!names.empty()) {
      ++counts[fmt::format("{}", fmt::join(names, ", "))];
    }
  }
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater(), &std::pair<std::string, int>::second);
  std::vector<FindingRow> rows;
  for (const auto& [order, count] : sorted) {
    rows.push_back({plain_finding("order", "order in which phases began first", order),
                    plain_finding("procedures", "procedures", count)});
  }
  return rows;
}

}  // namespace

bool is_divided(const ValidityResult& result) {
  return std::any_of(result.procedures.begin(), result.procedures.end(),
                     [](const ProcedureSummary& p) { return !p.phases.empty(); });
}

FindingList phase_findings(const ValidityResult& result) {
  FindingList list{.name = "phases", .heading = "Phases"};
  if (!is_divided(result)) {
    return list;
  }
  FindingTable times{"times", ""};
  for (const std::string& phase : all_phases(result)) {
    add_means(times, result, plain_finding("phase", "phase", phase), "s",
              [&](const std::vector<PhaseSpan>& spans) { return time_in(spans, phase); });
  }
  FindingTable changes{"changes", ""};
  add_means(changes, result, plain_finding("quantity", "quantity", "changes of the phase"), "",
            [](const std::vector<PhaseSpan>& spans) {
              return static_cast<double>(phase_changes(spans));
            });
  list.tables = {times, changes, {"orders", "", orders_of(result)}};
  Document words;
  words.paragraph(
      "A hidden Markov model (phases.json of the study) recognised them from the strokes: tool, "
      "depth, nearest structure, force, speed and view. It errs, by as much as haptrial bone "
      "phases said when it was learned. If it was learned from these same procedures it fits them "
      "better than others. Groups are not compared here.");
  list.blocks = words.blocks;
  return list;
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
