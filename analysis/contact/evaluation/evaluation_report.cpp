#include "analysis/contact/evaluation/evaluation_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/contact/evaluation/evaluation_tables.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/new_folder.h"
#include "core/base/file_text.h"

namespace haptrial::evaluation {
namespace {

using analysis::Document;

void add_identified(const IdentifiedContact& found, Document& document) {
  document.heading("What the contact is made of");
  document.points(identified_lines(found));
  for (const std::string& sentence : found.confounded) {
    document.paragraph(sentence);
  }
  document.paragraph(
      "Intervals are those of the noise, from blocks of neighbouring samples; what a registration "
      "or a sensor's offset turns throughout is not in them.");
}

void add_places(const Evaluation& e, Document& document) {
  std::vector<std::vector<std::string>> rows;
  for (const EvaluatedRendering& r : e.renderings) {
    for (const ProblemPlace& place : r.position.places) {
      rows.push_back({name_of(r), fmt::format("{:.3f}", e.contact.time[place.first]),
                      fmt::format("{:.3f}", e.contact.time[place.last]),
                      fmt::format("{:.2f}", 1e3 * place.worst)});
    }
  }
  if (!rows.empty()) {
    document.table({"renderer", "from (s)", "to (s)", "worst (mm)"}, rows,
                   fmt::format("{} places whose contact point is off by more than the threshold",
                               rows.size()));
  }
}

}  // namespace

Document evaluation_report(const Evaluation& e, const EvaluationNames& names,
                           const std::vector<analysis::Drawing>& drawings) {
  Document document;
  document.title = "Rendered beside real contact";
  document.simulated = names.simulated;
  document.subtitle = fmt::format("{} on {}", names.recording, names.mesh);
  if (names.simulated) {
    document.title = "Rendered beside simulated contact";
    document.alarm("SIMULATED RECORDING: no hand touched a body.");
  }
  std::vector<std::string> lines = evaluation_lines(e);
  lines.erase(std::find(lines.begin(), lines.end(), ""), lines.end());  // facts before the tables
  document.points(lines);
  document.heading("Force error");
  const TextTable errors = error_table(e), costs = cost_table(e);
  document.table(errors.heading, errors.rows);
  for (const EvaluatedRendering& r : e.renderings) {
    document.paragraph(fmt::format("{}: {}", name_of(r), r.noticeable.verdict));
  }
  add_places(e, document);
  if (e.cross) {
    const TextTable cross = cross_table(*e.cross);
    document.heading("Fitted on one recording, tested on another");
    document.table(cross.heading, cross.rows);
  }
  for (const analysis::Drawing& drawing : drawings) {
    document.picture(drawing);
  }
  document.heading("Cost");
  document.table(costs.heading, costs.rows);
  const TextTable operations = operation_table(e);
  document.table(operations.heading, operations.rows);
  if (e.identified) {
    add_identified(*e.identified, document);
  }
  document.heading("Remarks");
  for (const std::string& remark : e.remarks) {
    document.paragraph(remark);
  }
  return document;
}

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
