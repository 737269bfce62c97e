#include "analysis/bone_drilling/report/checklist_section.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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

FindingValue percent(const std::optional<double>& share) {
  return share ? FindingValue(100.0 * *share) : FindingValue();
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

double mean_points(const CheckedStudy& study, std::size_t item) {
  double sum = 0.0;
  for (const CheckedRow& row : study.rows) {
    sum += row.points[item];
  }
  return sum / static_cast<double>(study.rows.size());
}

/// Mean over a group's procedures of the raters' mean total.
FindingRow total_row(const CheckedStudy& study, const ByProcedure& all,
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
  return {plain_finding("group", "group", group),
          plain_finding("mean_total", "mean total", count > 0 ? sum / count : FindingValue(), "%"),
          plain_finding("procedures", "procedures", count)};
}

FindingRow item_row(const CheckedStudy& study, std::size_t n) {
  const ChecklistItem& item = study.checklist.items[n];
  return {
      plain_finding("item", "item", item.text),
      plain_finding("weight", "weight", item.weight),
      plain_finding("of", "of", item.points),
      plain_finding("mean_points", "mean points", mean_points(study, n)),
      plain_finding("same_points", "pairs of raters with the same points",
                    percent(same_points(study, n)), "%"),
      plain_finding("as_measured", "as its measure proposed", percent(as_measured(study, n)), "%")};
}

/// Whether no participant has two of the procedures.
bool of_different_people(const ByProcedure& all, const std::vector<ProcedureSummary>& procedures) {
  std::set<std::string> people;
  for (const auto& [key, rows] : all) {
    const auto at = std::ranges::find(
        procedures, key, [](const ProcedureSummary& p) { return std::pair(p.session, p.number); });
    people.insert(at != procedures.end() ? at->participant : key.first);
  }
  return people.size() == all.size();
}

/// @param apart  procedures are of different participants: else there is no interval
Finding agreement_finding(const Defined<Intraclass>& agreement, bool apart) {
  Finding finding{.name = "icc_2_1",
                  .title = "Agreement of one rater with another in the total, ICC(2,1)",
                  .form = JsonForm::kEstimate};
  if (agreement && agreement->random_raters) {
    finding.value = agreement->random_raters->value;
    if (apart) {
      finding.low = agreement->random_raters->low;
      finding.high = agreement->random_raters->high;
    }
    finding.n = agreement->targets;
  } else {
    finding.why_not = agreement ? agreement->random_raters.because() : agreement.because();
  }
  return finding;
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

FindingList checklist_findings(const CheckedStudy& study,
                               const std::vector<ProcedureSummary>& procedures,
                               const std::vector<std::string>& groups) {
  FindingList list{.name = "checklist", .heading = "Checklist: " + study.checklist.name};
  if (study.rows.empty()) {
    return list;
  }
  const ByProcedure all = by_procedure(study);
  const bool apart = of_different_people(all, procedures);
  list.findings = {plain_finding("raters", "raters", raters_of(study).size()),
                   plain_finding("procedures", "procedures", all.size()),
                   agreement_finding(checklist_agreement(study), apart)};
  FindingTable totals{"groups", ""};
  for (const std::string& group : groups) {
    totals.rows.push_back(total_row(study, all, procedures, group));
  }
  FindingTable items{"items", ""};
  for (std::size_t n = 0; n < study.checklist.items.size(); ++n) {
    items.rows.push_back(item_row(study, n));
  }
  list.tables = {totals, items};
  Document words;
  words.paragraph(
      std::string(
          "Raters filled it in without knowing whose procedures they were. The total is the "
          "weighted share of all points. They saw what the measures proposed, which brings "
          "them together.") +
      (apart ? ""
             : " An interval of their agreement would count every procedure as independent, so "
               "there is none: participants have several."));
  list.blocks = words.blocks;
  return list;
}

}  // namespace haptrial::analysis::drilling
