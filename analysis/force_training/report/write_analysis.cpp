#include "analysis/force_training/report/write_analysis.h"

#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/staging.h"
#include "analysis/force_training/report/report.h"
#include "analysis/force_training/report/study_figures.h"
#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

}  // namespace

void write_analysis(const StudyResult& study, const fs::path& folder, int paper,
                    const std::vector<FindingList>& own) {
  const Staging staging(folder);
  staging.write("scores.csv", scores_csv(study.scores, study.factors));
  staging.write("statistics.json", statistics_json(study, own));
  auto figures = study_figures(study);
  write_findings(own, staging, figures);
  draw_figures(figures, staging.path(), paper);
  std::vector<Drawing> drawings;
  for (const auto& figure : figures) {
    drawings.push_back({figure, file_text(staging.path() / (figure.name + ".svg"))});
  }
  Document report = study_report(study, drawings);
  add_findings(report, own, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis
