#include "analysis/force_training/report/write_analysis.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/staging.h"
#include "analysis/force_training/report/recall_frequency_findings.h"
#include "analysis/force_training/report/report.h"
#include "analysis/force_training/report/study_figures.h"
#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/learned_scores.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

}  // namespace

void write_analysis(const StudyResult& study, const fs::path& folder, int paper,
                    const std::vector<FindingList>& own) {
  const Staging staging(folder);
  staging.write("scores.csv", scores_csv(study.scores, study.factors));
  if (!study.planned_sessions.empty()) {
    staging.write("session_scores.csv", session_scores_csv(study));
  }
  const FindingList by_frequency = recall_frequency_findings(study.frequencies, study.simulated());
  std::vector<FindingList> lists = own;
  staging.write("statistics.json", statistics_json(study, own));
  auto figures = study_figures(study);
  std::ranges::move(learning_figures(study.learned, study.simulated()),
                    std::back_inserter(figures));
  write_findings(own, staging, figures);
  if (by_frequency.has_values() || !study.frequencies) {
    lists.insert(lists.begin(), by_frequency);
  }
  if (by_frequency.has_values()) {
    figures.insert(figures.end(), by_frequency.figures.begin(), by_frequency.figures.end());
    staging.write(
        "recall_by_frequency.csv",
        findings_csv(by_frequency.tables, {{"frequency", "at"}, {"condition", "condition"}}));
  }
  draw_figures(figures, staging.path(), paper);
  std::vector<Drawing> drawings;
  for (const auto& figure : figures) {
    drawings.push_back({figure, file_text(staging.path() / (figure.name + ".svg"))});
  }
  Document report = study_report(study, drawings);
  add_findings(report, lists, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis
