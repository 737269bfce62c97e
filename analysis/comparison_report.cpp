#include <fmt/format.h>

#include <fstream>

#include "analysis/comparison.h"
#include "analysis/figure_gnuplot.h"
#include "analysis/html.h"
#include "analysis/palette.h"
#include "analysis/report_style.h"
#include "analysis/wording.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

constexpr const char* kFigure = "comparison";

std::string paragraph(const std::string& text) { return "<p>" + escape_html(text) + "</p>\n"; }

std::string pace_of(const ScoredStudy& study) {
  return study.own_pace ? "at the participants' own pace" : "at the pace of the trajectory";
}

bool simulated(const StudyComparison& c) { return c.first.simulated || c.second.simulated; }

Figure figure_of(const StudyComparison& comparison) {
  Figure figure;
  figure.name = kFigure;
  figure.title = "Recall error in two studies";
  figure.x_label = "Training condition";
  figure.y_label = "Recall error (0 is perfect)";
  figure.simulated = simulated(comparison);
  Series first{comparison.first.name, Mark::kBars, {palette::kBlue, palette::kSolid, 7, 2.5, 1.2}};
  Series second{
      comparison.second.name, Mark::kBars, {palette::kOrange, palette::kSolid, 5, 2.5, 1.2}};
  double highest = 0.0;
  double place = 0.0;
  for (const auto& c : comparison.conditions) {
    figure.x_names.emplace_back(++place, capitalized(c.condition));
    const auto add = [&](Series& series, double x, const Defined<MeanInterval>& m) {
      if (m) {
        series.x.push_back(x);
        series.y.push_back(m->mean);
        series.low.push_back(m->low);
        series.high.push_back(m->high);
        highest = std::max(highest, m->high);
      }
    };
    add(first, place - 0.1, c.first);
    add(second, place + 0.1, c.second);
  }
  for (const Series& series : {first, second}) {
    if (!series.x.empty()) {
      figure.series.push_back(series);
    }
  }
  figure.x_range = Range{0.4, place + 0.6};
  figure.y_range = Range{0.0, highest > 0.0 ? 1.1 * highest : 1.0};
  figure.caption =
      "Mean over participants of their mean recall error, with 95 % confidence intervals over "
      "participants.";
  figure.alt = "Mean recall error by training condition, one point for each study.";
  return figure;
}

std::string html_of(const StudyComparison& comparison, const std::string& svg,
                    const Figure& figure) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}Two studies compared</title>\n<style>{}</style>\n</head>\n<body>\n"
      "<h1>Two studies compared</h1>\n",
      simulated(comparison) ? "SIMULATED: " : "", kReportStyle);
  if (simulated(comparison)) {
    html +=
        "<div class=\"banner\">SIMULATED PARTICIPANTS: these data come from virtual subjects. They "
        "say how the experiments and their analysis work, not how people learn.</div>\n";
  }
  html += "<ul class=\"lines\">\n";
  for (const std::string& line : comparison_lines(comparison)) {
    html += "<li>" + escape_html(line) + "</li>\n";
  }
  html += "</ul>\n<figure>\n" + inline_svg(svg, kFigure, figure.title + ". " + figure.alt) +
          "\n<figcaption>" + escape_html(figure.caption) + "</figcaption>\n</figure>\n";
  html += paragraph(
      "Where one study compares forces over time and the other over the place on the path, the "
      "place is taken as the time that it takes at the definition's speed, so that the scores have "
      "the same units. Participants of the same identifier are taken for the same person; Welch's "
      "test takes nobody for the same.");
  std::vector<std::vector<std::string>> rows;
  for (const auto& c : comparison.conditions) {
    const auto difference = c.paired ? fmt::format("{} ({} to {})", number(c.paired->difference),
                                                   number(c.paired->low), number(c.paired->high))
                                     : "not defined, because " + c.paired.because();
    rows.push_back({capitalized(c.condition), mean_with_interval(c.first),
                    mean_with_interval(c.second), difference, t_result(c.paired),
                    c.paired_holm ? p_value(*c.paired_holm) : "-", t_result(c.welch)});
  }
  html += html_table(
      {"Condition", comparison.first.name, comparison.second.name, "Difference within participants",
       "Paired t-test", "After Holm", "Welch's t-test"},
      rows);
  return html + "</body>\n</html>\n";
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    throw RunError(fmt::format("{}: could not be written", file.string()));
  }
}

}  // namespace

std::vector<std::string> comparison_lines(const StudyComparison& comparison) {
  const auto opening = [&](const ScoredStudy& study, const StudyStatistics& s) {
    return fmt::format(
        "{}: {} of {}, {}; conditions {}", study.name, counted(study.scores.size(), "scored trial"),
        counted(s.subjects.size(), study.simulated ? "simulated participant" : "participant"),
        pace_of(study), anova_result(s.repeated));
  };
  std::vector<std::string> lines{opening(comparison.first, comparison.first_statistics),
                                 opening(comparison.second, comparison.second_statistics)};
  for (const auto& c : comparison.conditions) {
    lines.push_back(fmt::format("{}: mean recall error {} and {}; within {} {}",
                                capitalized(c.condition), c.first ? number(c.first->mean) : "-",
                                c.second ? number(c.second->mean) : "-",
                                counted(c.shared, "participant"), t_result(c.paired)));
  }
  return lines;
}

void write_comparison(const StudyComparison& comparison, const std::filesystem::path& folder) {
  const Figure figure = figure_of(comparison);
  draw_figures({figure}, folder);
  const std::string svg = file_text(folder / (figure.name + ".svg"));
  write(folder / "comparison.json", comparison_json(comparison));
  write(folder / "comparison.html", html_of(comparison, svg, figure));
}

}  // namespace haptrial::analysis
