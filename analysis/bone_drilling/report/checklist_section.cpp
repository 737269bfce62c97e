#include "analysis/bone_drilling/report/checklist_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/counted.h"

namespace haptrial::analysis::drilling {
namespace {

using Key = std::pair<std::string, int>;
using ByProcedure = std::map<Key, std::vector<const CheckedRow*>>;  // in order of raters

ByProcedure by_procedure(const CheckedStudy& study) {
  ByProcedure all;
  for (const CheckedRow& row : study.rows) {
    all[{row.session, row.procedure}].push_back(&row);
  }
  for (auto& [key, rows] : all) {
    std::sort(rows.begin(), rows.end(),
              [](const CheckedRow* a, const CheckedRow* b) { return a->rater < b->rater; });
  }
  return all;
}

std::set<std::string> raters_of(const CheckedStudy& study) {
  std::set<std::string> raters;
  for (const CheckedRow& row : study.rows) {
    raters.insert(row.rater);
  }
  return raters;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.0f} %", 100.0 * *share) : "–";
}

/// Share of points that are those that the measure proposed.
std::optional<double> as_measured(const CheckedStudy& study, std::size_t item) {
  double same = 0.0, all = 0.0;
  for (const CheckedRow& row : study.rows) {
    if (row.proposed[item] >= 0) {
      all += 1.0;
      same += row.points[item] == row.proposed[item] ? 1.0 : 0.0;
    }
  }
  return all > 0.0 ? std::optional(same / all) : std::nullopt;
}

std::string mean_points(const CheckedStudy& study, std::size_t item) {
  double sum = 0.0;
  for (const CheckedRow& row : study.rows) {
    sum += row.points[item];
  }
  return fmt::format("{:.2f}", sum / static_cast<double>(study.rows.size()));
}

/// Mean over a group's procedures of the raters' mean total.
std::string mean_total(const CheckedStudy& study, const ByProcedure& all,
                       const std::vector<ProcedureSummary>& procedures, const std::string& group) {
  double sum = 0.0;
  int count = 0;
  for (const ProcedureSummary& p : procedures) {
    const auto own = all.find({p.session, p.number});
    if (p.group != group || own == all.end()) {
      continue;
    }
    double total = 0.0;
    for (const CheckedRow* row : own->second) {
      total += total_of(study.checklist, row->points);
    }
    sum += total / static_cast<double>(own->second.size());
    ++count;
  }
  return count > 0 ? fmt::format("{:.1f} ({})", sum / count, count) : "–";
}

}  // namespace

Defined<Intraclass> checklist_agreement(const CheckedStudy& study) {
  const std::set<std::string> raters = raters_of(study);
  std::vector<std::vector<double>> complete;
  for (const auto& [key, rows] : by_procedure(study)) {
    if (rows.size() == raters.size()) {
      complete.emplace_back();
      for (const CheckedRow* row : rows) {
        complete.back().push_back(total_of(study.checklist, row->points));
      }
    }
  }
  Eigen::MatrixXd totals(static_cast<Eigen::Index>(complete.size()),
                         static_cast<Eigen::Index>(raters.size()));
  for (std::size_t i = 0; i < complete.size(); ++i) {
    totals.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(complete[i].data(), totals.cols());
  }
  return intraclass_correlation(totals);
}

std::optional<double> same_points(const CheckedStudy& study, std::size_t item) {
  double same = 0.0, pairs = 0.0;
  for (const auto& [key, rows] : by_procedure(study)) {
    for (std::size_t a = 0; a < rows.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        pairs += 1.0;
        same += rows[a]->points[item] == rows[b]->points[item] ? 1.0 : 0.0;
      }
    }
  }
  return pairs > 0.0 ? std::optional(same / pairs) : std::nullopt;
}

void add_checklist_section(Document& document, const CheckedStudy& study,
                           const std::vector<ProcedureSummary>& procedures,
                           const std::vector<std::string>& groups, bool simulated) {
  if (study.rows.empty()) {
    return;
  }
  const std::string title = "Checklist: " + study.checklist.name;
  document.heading(simulated ? title + " (simulated)" : title);
  const ByProcedure all = by_procedure(study);
  document.paragraph(fmt::format(
      "{} filled it in for {} without knowing whose they were. The total is the weighted share of "
      "all points.",
      counted(raters_of(study).size(), "rater", "raters"),
      counted(all.size(), "procedure", "procedures")));
  std::vector<std::string> totals{"mean total [%] (procedures)"};
  std::vector<std::string> heading{""};
  for (const std::string& group : groups) {
    heading.push_back(group);
    totals.push_back(mean_total(study, all, procedures, group));
  }
  document.table(heading, {totals});
  std::vector<std::vector<std::string>> rows;
  for (std::size_t n = 0; n < study.checklist.items.size(); ++n) {
    const ChecklistItem& item = study.checklist.items[n];
    rows.push_back({item.text, fmt::format("{:g}", item.weight), std::to_string(item.points),
                    mean_points(study, n), percent(same_points(study, n)),
                    percent(as_measured(study, n))});
  }
  document.table({"item", "weight", "of", "mean points", "pairs of raters with the same points",
                  "as its measure proposed"},
                 rows);
  const Defined<Intraclass> agreement = checklist_agreement(study);
  document.paragraph(
      agreement && agreement->random_raters
          ? fmt::format("Agreement of one rater with another in the total: ICC(2,1) = {:.2f} over "
                        "{} procedures. Raters saw what the measures proposed, which brings them "
                        "together.",
                        agreement->random_raters->value, agreement->targets)
          : fmt::format("The intraclass correlation of the totals is not defined: {}.",
                        agreement ? agreement->random_raters.because() : agreement.because()));
}

}  // namespace haptrial::analysis::drilling
