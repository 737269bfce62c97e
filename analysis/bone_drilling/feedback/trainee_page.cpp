#include "analysis/bone_drilling/feedback/trainee_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "analysis/bone_drilling/feedback/achieved_tables.h"
#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/phase_tables.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/bone_drilling/feedback/range_plot.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

using Value = std::function<std::optional<double>(const TraineeProcedure&)>;

/// Something that may be learned.
struct Line {
  std::string title;
  std::string unit;
  Value value;
  std::optional<SafeRange> experts;
};

/// Time in each phase, where procedures are divided.
void add_phases(const std::vector<TraineeProcedure>& procedures, const Experts& experts,
                std::vector<Line>& lines) {
  std::vector<std::vector<PhaseSpan>> divided;
  for (const TraineeProcedure& p : procedures) {
    if (!p.summary.phases.empty()) {
      divided.push_back(p.summary.phases);
    }
  }
  for (const std::string& phase : phases_in_order(divided)) {
    const auto time = [phase](const TraineeProcedure& p) -> std::optional<double> {
      return p.summary.phases.empty() ? std::nullopt
                                      : std::optional(time_in(p.summary.phases, phase));
    };
    lines.push_back({"phase " + phase, "s", time, experts_time(experts, phase)});
  }
}

std::vector<Line> lines_of(const std::vector<TraineeProcedure>& procedures,
                           const Experts& experts) {
  std::vector<Line> lines;
  for (const AchievedFigure& figure : figures_of(procedures.front().summary.achieved)) {
    lines.push_back({figure.title, figure.unit,
                     [column = figure.column](const TraineeProcedure& p) {
                       return achieved_value(p.summary, column);
                     },
                     achieved_range(experts, figure.column)});
  }
  for (const MetricKind& kind : shown_metrics()) {
    lines.push_back(
        {kind.title, kind.unit,
         [name = kind.name](const TraineeProcedure& p) { return p.summary.value(name); },
         experts_range(experts, kind.name)});
  }
  add_phases(procedures, experts, lines);
  const auto share = [](std::size_t TraineeProcedure::*part) {
    return [part](const TraineeProcedure& p) -> std::optional<double> {
      if (p.judged == 0) {
        return std::nullopt;
      }
      return 100.0 * static_cast<double>(p.*part) / static_cast<double>(p.judged);
    };
  };
  lines.push_back({"voxels removed with too much force", "%", share(&TraineeProcedure::too_hard),
                   std::nullopt});
  lines.push_back(
      {"voxels removed too fast", "%", share(&TraineeProcedure::too_fast), std::nullopt});
  return lines;
}

std::string plots(const std::vector<TraineeProcedure>& procedures, const std::vector<Line>& lines) {
  std::string html = "<div class=\"plots\">\n";
  for (const Line& line : lines) {
    RangePlot plot;
    plot.title = line.title;
    plot.x_label = "procedure";
    plot.y_label = line.unit == "1" ? "" : line.unit;
    plot.x_low = 0.5;
    plot.x_high = static_cast<double>(procedures.size()) + 0.5;
    plot.whole_numbers = true;
    plot.joined = true;
    for (std::size_t n = 0; n < procedures.size(); ++n) {
      if (const auto value = line.value(procedures[n])) {
        plot.points.push_back({static_cast<double>(n + 1), *value, false});
      }
    }
    if (plot.points.empty()) {
      continue;
    }
    if (line.experts) {
      plot.ranges.push_back(
          {plot.x_low, plot.x_high, line.experts->low, line.experts->median, line.experts->high});
    }
    html += range_svg(plot);
  }
  return html + "</div>\n";
}

std::string links(const std::vector<TraineeProcedure>& procedures) {
  std::string html =
      "<div class=\"scroll\"><table id=\"procedures\">\n<thead><tr><th>procedure</th>"
      "<th>session</th><th>trial</th><th>started (UTC)</th><th>completed</th></tr></thead>\n"
      "<tbody>\n";
  for (std::size_t n = 0; n < procedures.size(); ++n) {
    const TraineeProcedure& p = procedures[n];
    html += fmt::format(
        "<tr><td><a href=\"{}\">{}</a></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape_html(p.page), n + 1, escape_html(p.summary.session), p.summary.number,
        escape_html(p.started), p.summary.completed ? "yes" : "no");
  }
  return html + "</tbody></table></div>\n";
}

std::string values_table(const std::vector<TraineeProcedure>& procedures,
                         const std::vector<Line>& lines) {
  std::vector<std::string> names{"metric", "unit"};
  for (std::size_t n = 0; n < procedures.size(); ++n) {
    names.push_back(std::to_string(n + 1));
  }
  names.emplace_back("experts' range");
  std::vector<std::vector<std::string>> rows;
  for (const Line& line : lines) {
    std::vector<std::string> row{line.title, line.unit == "1" ? "" : line.unit};
    for (const TraineeProcedure& p : procedures) {
      row.push_back(number_text(line.value(p)));
    }
    row.push_back(line.experts
                      ? number_text(line.experts->low) + " to " + number_text(line.experts->high)
                      : "-");
    rows.push_back(std::move(row));
  }
  return html_table(names, rows);
}

}  // namespace

std::string trainee_page(const std::string& participant,
                         const std::vector<TraineeProcedure>& procedures, const Experts& experts,
                         const std::string& curriculum) {
  const bool simulated = std::any_of(procedures.begin(), procedures.end(),
                                     [](const TraineeProcedure& p) { return p.summary.simulated; });
  const std::vector<Line> lines = lines_of(procedures, experts);
  std::string body = simulated_banner(simulated, experts.simulated);
  body += links(procedures);
  body += curriculum;
  body += heading("Learning");
  body += paragraph(experts.summaries.empty()
                        ? "There are no experts to compare with."
                        : fmt::format("The band runs from the smallest to the largest value of {} "
                                      "experts' procedures; the dashed line is their median.",
                                      experts.summaries.size()));
  body += plots(procedures, lines) + heading("Figures") + values_table(procedures, lines);
  return whole_page("Procedures of " + participant, simulated, body);
}

}  // namespace haptrial::analysis::drilling
