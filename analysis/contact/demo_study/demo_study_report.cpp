#include "analysis/contact/demo_study/demo_study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "analysis/contact/demo_study/demo_study_figures.h"
#include "analysis/contact/evaluation/evaluation_tables.h"
#include "analysis/document/document.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/new_folder.h"
#include "core/base/file_text.h"

namespace haptrial::evaluation {
namespace {

TextTable errors(const std::vector<DemoStudyRow>& rows, std::span<const double> source) {
  TextTable table{
      {"renderer", "triangles", "friction", "error (N)", "of the normal force (N)", "source (N)"},
      {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DemoStudyRow& r = rows[i];
    table.rows.push_back({r.renderer, fmt::format("{}", r.triangles),
                          fmt::format("{:.4f}", r.friction), fmt::format("{:.4f}", r.error),
                          fmt::format("{:.4f}", r.normal_error), fmt::format("{:.3f}", source[i])});
  }
  return table;
}

TextTable table4(const DemoStudyTables& t) { return errors(t.table4, kSourceTable4); }
TextTable table5(const DemoStudyTables& t) { return errors(t.table5, kSourceTable5); }
TextTable table6(const DemoStudyTables& t) {
  TextTable table = errors(t.table6, kSourceTable6);
  table.heading.insert(table.heading.end() - 1, {"shaded (N)", "of the normal force, shaded (N)"});
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    auto& row = table.rows[i];
    row.insert(row.end() - 1, {fmt::format("{:.4f}", t.shaded[i].error),
                               fmt::format("{:.4f}", t.shaded[i].normal_error)});
  }
  return table;
}

TextTable costs(const DemoStudyTables& t) {
  TextTable table{
      {"renderer", "triangles", "friction", "tick (us)", "preparation (s)", "memory (MB)"}, {}};
  for (const auto* rows : {&t.table4, &t.table5, &t.table6}) {
    for (const DemoStudyRow& r : *rows) {
      table.rows.push_back({r.renderer, fmt::format("{}", r.triangles),
                            fmt::format("{:.4f}", r.friction), fmt::format("{:.2f}", 1e6 * r.tick),
                            fmt::format("{:.3f}", r.preparation),
                            fmt::format("{:.2f}", 1e-6 * r.memory)});
    }
  }
  return table;
}

TextTable operations(const DemoStudyTables& t) {
  TextTable table{{"renderer", "triangles", "friction"}, {}};
  std::vector<DemoStudyRow> rows;
  for (const auto* more : {&t.table4, &t.table5, &t.table6}) {
    rows.insert(rows.end(), more->begin(), more->end());
  }
  std::vector<contact::Operations> all;
  for (const DemoStudyRow& r : rows) {
    all.push_back(r.operations);
  }
  const auto counts = counted(all);
  for (const contact::OperationCount& c : counts) {
    table.heading.push_back(fmt::format("{}, mean", c.name));
    table.heading.push_back(fmt::format("{}, most", c.name));
  }
  for (const DemoStudyRow& r : rows) {
    auto& row = table.rows.emplace_back();
    row = {r.renderer, fmt::format("{}", r.triangles), fmt::format("{:.4f}", r.friction)};
    const double ticks = std::max(1.0, static_cast<double>(r.operations.ticks));
    for (const contact::OperationCount& c : counts) {
      row.push_back(fmt::format("{:.3f}", static_cast<double>(r.operations.*c.count) / ticks));
      row.push_back(fmt::format("{}", r.most.*c.count));
    }
  }
  return table;
}

TextTable failures(const std::vector<FailureMap>& maps) {
  TextTable table{{"ridge under"}, {}};
  for (const RidgeOutcome outcome : kRidgeOutcomes) {
    table.heading.emplace_back(name_of(outcome));
  }
  for (const FailureMap& map : maps) {
    table.rows.push_back({name_of(map)});
    for (const RidgeOutcome outcome : kRidgeOutcomes) {
      table.rows.back().push_back(fmt::format("{}", map.count(outcome)));
    }
  }
  return table;
}

std::string csv_of(const TextTable& table) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      // "voxel, 32^3" holds a comma.
      const bool quoted = row[c].find(',') != std::string::npos;
      fmt::format_to(std::back_inserter(text), "{}{}{}{}", c == 0 ? "" : ",", quoted ? "\"" : "",
                     row[c], quoted ? "\"" : "");
    }
    text += '\n';
  };
  add(table.heading);
  for (const auto& row : table.rows) {
    add(row);
  }
  return text;
}

std::vector<std::string> facts(const DemoStudyTables& t) {
  const Registration& r = *t.contact.registration;
  return {
      fmt::format("Seed {}; {:.0f} s of a probe that presses with {:.2f} N in the mean on a "
                  "duck with a friction of {:.2f}; in-trajectory of {:.0f} N/m.",
                  t.options.seed, t.options.seconds, t.mean_force, t.options.friction,
                  t.options.stiffness),
      fmt::format("The scan lies {:.3f} mm from the duck (root mean square).", 1e3 * t.scan_error),
      fmt::format("Found: lag {:.2f} ms of 40 ms; load {:.3f} N of 0.4 N; the path lies {:.3f} "
                  "mm from the scan (median).",
                  1e3 * t.contact.lag_used, t.contact.load->load.weight.norm(), 1e3 * r.median),
      fmt::format("Best friction {:.4f}: error {:.4f} N in place of {:.4f} N.", t.friction.friction,
                  t.friction.with, t.friction.without)};
}

}  // namespace

std::vector<std::string> demo_study_lines(const DemoStudyTables& t,
                                          const std::vector<FailureMap>& maps) {
  std::vector<std::string> lines{"SIMULATED RECORDING"};
  const auto append = [&](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  append(facts(t));
  for (const TextTable& table : {table4(t), table5(t), table6(t), failures(maps), costs(t)}) {
    lines.emplace_back();
    append(text_lines(table));
  }
  return lines;
}

namespace {

/// A report that grows: each table is a file as well.
class Report {
 public:
  explicit Report(const std::filesystem::path& folder) : out_(folder) {}

  void begin(const DemoStudyTables& t) {
    document_.title = "Rendered beside simulated contact: the source's duck made anew";
    document_.simulated = true;
    document_.alarm("SIMULATED RECORDING: no hand touched a body.");
    document_.points(facts(t));
  }
  void add(const char* heading, const char* name, const TextTable& table) {
    add(heading, name, table, csv_of(table));
  }
  void add(const char* heading, const char* name, const TextTable& table, const std::string& file) {
    document_.heading(heading);
    document_.table(table.heading, table.rows);
    out_.write(name, file);
  }
  /// Draws them. They are put into the document one by one.
  void draw(const std::vector<analysis::Figure>& figures) {
    const std::filesystem::path place = out_.place("report.html").parent_path();
    analysis::draw_figures(figures, place);
    for (const analysis::Figure& figure : figures) {
      drawings_.push_back({figure, file_text(place / (figure.name + ".svg"))});
    }
  }
  void put_pictures(std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      document_.picture(drawings_[i]);
    }
  }
  void remark(const std::vector<std::string>& remarks) {
    document_.heading("Remarks");
    for (const std::string& remark : remarks) {
      document_.paragraph(remark);
    }
  }
  void publish() {
    out_.write("report.html", analysis::to_html(document_));
    out_.publish();
  }

 private:
  exchange::NewFolder out_;
  std::vector<analysis::Drawing> drawings_;  // the document keeps where they are
  analysis::Document document_;
};

}  // namespace

void write_demo_study(const DemoStudyTables& t, const std::vector<FailureMap>& maps,
                      const std::filesystem::path& folder) {
  std::vector<analysis::Figure> figures{trajectory_figure(t), path_figure(t), resolution_figure(t)};
  const std::size_t before = 2, of_tables = figures.size();
  for (const FailureMap& map : maps) {
    figures.push_back(failure_figure(map));
  }
  Report report(folder);
  report.begin(t);
  report.draw(figures);
  report.put_pictures(0, before);
  report.add("Table 4: proxy and voxels", "table-4.csv", table4(t));
  report.add("Table 5: friction", "table-5.csv", table5(t));
  report.add("Table 6: size of the mesh", "table-6.csv", table6(t));
  report.put_pictures(before, of_tables);
  report.add("Figure 65: a ridge, where each algorithm fails", "failures.csv", failures(maps),
             failure_csv(maps));
  report.put_pictures(of_tables, figures.size());
  report.add("Operations a tick", "operations.csv", operations(t));
  report.add("Costs on this computer", "costs.csv", costs(t));
  report.remark(t.contact.remarks);
  report.publish();
}

}  // namespace haptrial::evaluation
