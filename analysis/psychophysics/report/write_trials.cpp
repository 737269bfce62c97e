#include "analysis/psychophysics/report/write_trials.h"

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/staging.h"
#include "analysis/psychophysics/data/trials_csv.h"
#include "analysis/psychophysics/report/reaches_csv.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_json.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "core/base/file_text.h"

namespace haptrial::analysis::trials {

void write_trials(const TrialsResult& result, const std::filesystem::path& folder, int paper,
                  const std::vector<FindingList>& own) {
  const Staging staging(folder);
  trials_csv(result.data, [&](const std::string& text) { staging.append("trials.csv", text); });
  staging.write("estimates.csv", estimates_csv(result));
  results_json(result, own, [&](const std::string& text) { staging.append("results.json", text); });
  if (!result.surfaces.empty()) {
    staging.write("surfaces.csv", surfaces_csv(result));
  }
  if (result.reaching) {
    staging.write("reaches.csv", reaches_csv(result));
  }
  std::vector<Figure> figures = trials_figures(result);
  write_findings(own, staging, figures);
  draw_figures(figures, staging.path(), paper);
  std::vector<Drawing> drawings;
  for (const Figure& figure : figures) {
    drawings.push_back({figure, file_text(staging.path() / (figure.name + ".svg"))});
  }
  Document report = trials_report(result, drawings);
  add_findings(report, own, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis::trials
