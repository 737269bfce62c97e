#include "analysis/contact/evaluation/write_evaluation.h"

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/new_folder.h"
#include "core/base/file_text.h"

namespace haptrial::evaluation {

void write_evaluation(const Evaluation& evaluation, const EvaluationNames& names,
                      const std::filesystem::path& folder) {
  exchange::NewFolder out(folder);
  out.write("evaluation.json", evaluation_json(evaluation, names));
  out.write("contact.csv", contact_csv(evaluation));
  out.write("objects.toml", objects_toml(evaluation, names));
  const auto figures = evaluation_figures(evaluation, names);
  const std::filesystem::path place = out.place("report.html").parent_path();
  analysis::draw_figures(figures, place);
  std::vector<analysis::Drawing> drawings;
  for (const analysis::Figure& figure : figures) {
    drawings.push_back({figure, file_text(place / (figure.name + ".svg"))});
  }
  out.write("report.html", analysis::to_html(evaluation_report(evaluation, names, drawings)));
  out.publish();
}

}  // namespace haptrial::evaluation
