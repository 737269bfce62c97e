#include "analysis/power/power_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/document/palette.h"
#include "analysis/power/depth_check.h"
#include "analysis/power/power_words.h"

namespace haptrial::analysis {
namespace {

constexpr std::array kLooks{
    Look{palette::kBlue, palette::kSolid, 7, 2.2, 1.0},
    Look{palette::kOrange, palette::kLong, 5, 2.2, 1.0},
    Look{palette::kGreen, palette::kMixed, 9, 2.2, 1.0},
    Look{palette::kPurple, palette::kShort, 13, 2.2, 1.0},
};

std::string rejections(const PowerResult& result) {
  return is_power(result) ? "Power" : "Share of rejections (no power)";
}

std::size_t failed(const CellCounts& counts, const std::string& watch) {
  return counts.replications - counts.of(watch).made;
}

void add_cells(Document& report, const PowerResult& result) {
  std::vector<std::string> names;
  for (const PowerKey& key : result.keys) {
    names.push_back(key.name);
  }
  for (const char* name :
       {"Replications", "Test not made", "", "Effect on the report's scale", "Hours in the lab"}) {
    names.emplace_back(*name == '\0' ? rejections(result) + ", 95 % interval" : name);
  }
  std::vector<std::vector<std::string>> rows;
  for (const PowerCell& cell : result.cells) {
    std::vector<std::string> row;
    for (const double level : cell.levels) {
      row.push_back(fmt::format("{}", level));
    }
    const auto effect = cell.counts.values.find(result.watch);
    row.push_back(std::to_string(cell.counts.replications));
    row.push_back(std::to_string(failed(cell.counts, result.watch)));
    row.push_back(share_words(cell.counts.of(result.watch)));
    row.push_back(effect == cell.counts.values.end() ? "-" : mean_words(effect->second));
    row.push_back(fmt::format("{:.1f}", cell.counts.hours.mean));
    rows.push_back(std::move(row));
  }
  report.heading(is_power(result) ? "Power (simulated)" : "Rejections (simulated)");
  report.table(names, rows);
  report.paragraph(
      "Intervals are those of Clopper and Pearson and show the Monte Carlo error alone. The effect "
      "is the mean of the estimates over the replications with its standard error. Replications in "
      "which the test could not be made are left out of the share. Hours are those of the "
      "participants in sessions, roughly, from the times that the definition states.");
}

void add_levels(Document& report, const PowerResult& result) {
  report.heading("Without an effect (simulated)");
  if (result.nulls.empty()) {
    report.paragraph("No key of the question says what no effect is (none = …).");
    return;
  }
  std::vector<std::vector<std::string>> rows;
  for (const PowerCell& cell : result.nulls) {
    for (const auto& [name, count] : cell.counts.tests) {
      const CountBand band = binomial_band(count.made, result.alpha, kNullBand);
      rows.push_back({words_of(result, cell), name,
                      fmt::format("{} of {}", count.rejected, count.made),
                      fmt::format("{} to {}", band.low, band.high),
                      level_words(level_in(cell, name, result.alpha))});
    }
  }
  report.table({"Cell", "Test", fmt::format("Below {}", result.alpha),
                "99 % of tests that keep their level", "Finding"},
               rows);
}

void add_failures(Document& report, const PowerResult& result) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const PowerCell& cell, const CellCounts& counts, const char* depth) {
    for (const auto& [reason, count] : counts.reasons) {
      rows.push_back({words_of(result, cell), depth, reason, std::to_string(count)});
    }
  };
  const char* own = result.in_full ? "sessions" : "responses";
  for (const auto* cells : {&result.nulls, &result.cells}) {
    for (const PowerCell& cell : *cells) {
      add(cell, cell.counts, own);
      if (cell.sessions) {
        add(cell, *cell.sessions, "sessions");
      }
    }
  }
  report.heading("What failed (simulated)");
  if (rows.empty()) {
    report.paragraph("Nothing failed.");
    return;
  }
  report.table({"Cell", "Depth", "Reason", "Times"}, rows);
}

void add_check(Document& report, const PowerResult& result) {
  report.heading("Responses alone against full sessions (simulated)");
  if (result.in_full) {
    report.paragraph("Every study was simulated in full: servo loop, hand, device and report.");
    return;
  }
  const std::vector<DepthRow> rows = depth_check(result);
  if (rows.empty()) {
    report.alarm(
        "Participants were simulated at the level of responses, and this was not checked against "
        "full sessions (power.check).");
    return;
  }
  std::vector<std::vector<std::string>> table;
  for (const DepthRow& row : rows) {
    table.push_back({row.cell, row.value, mean_words(row.responses), mean_words(row.sessions),
                     fmt::format("{:.2f}", row.z), row.agrees ? "agrees" : "DIFFERS"});
  }
  if (std::ranges::any_of(rows, [](const DepthRow& row) { return !row.agrees; })) {
    report.alarm(
        "Responses alone do not give what full sessions give (below): do not plan with these "
        "numbers before the formula of power.responses is mended, or depth is \"sessions\".");
  }
  report.table({"Cell", "Number of the report", "Responses", "Sessions", "z", "Finding"}, table);
}

}  // namespace

Figure power_figure(const PowerResult& result) {
  const std::size_t key = result.participants().value_or(0);
  Figure figure;
  figure.name = "power";
  figure.title = rejections(result);
  figure.x_label = result.participants() ? "Participants"
                   : result.keys.empty() ? ""
                                         : result.keys.front().name;
  figure.y_label = rejections(result);
  figure.y_range = Range{0.0, 1.0};
  figure.simulated = true;
  figure.caption =
      "Shares of simulated studies in which the test is below alpha, with 95 % intervals.";
  std::size_t number = 0;
  for (const PowerLine& line : lines_over(result, key)) {
    Series series{line.name, Mark::kLinkedBars, kLooks[number++ % kLooks.size()]};
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const TestCount count = line.cells[i]->counts.of(result.watch);
      if (count.made > 0) {
        const Share share = share_of(count.rejected, count.made);
        series.x.push_back(line.x[i]);
        series.y.push_back(share.value);
        series.low.push_back(share.low);
        series.high.push_back(share.high);
        figure.alt += fmt::format("{}{} {}: {:.3f}", figure.alt.empty() ? "" : "; ", line.name,
                                  line.x[i], share.value);
      }
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

Document power_report(const PowerResult& result, const Drawing& drawing) {
  Document report;
  report.title = "Power of " + result.title + " (SIMULATED)";
  report.subtitle = fmt::format("Test: {}; alpha {}; seed {}; {}", result.watch, result.alpha,
                                result.seed, result.program);
  report.simulated = true;
  report.alarm(
      "SIMULATED: every participant below is virtual. The numbers say what the definition and its "
      "report would find if people were like these, and nothing about people.");
  if (is_power(result)) {
    report.points(power_lines(result));
  } else {
    report.alarm(verdict(result));
  }
  if (!drawing.figure.series.empty()) {
    report.picture(drawing);
  }
  add_cells(report, result);
  add_levels(report, result);
  add_check(report, result);
  add_failures(report, result);
  report.heading("The question");
  report.source("Definition with its table [power]", result.question);
  return report;
}

std::vector<std::string> power_lines(const PowerResult& result) {
  std::vector<std::string> lines{"SIMULATED: " + verdict(result)};
  for (std::string& line : size_lines(result)) {
    lines.push_back(std::move(line));
  }
  std::size_t rows = 0, differ = 0;
  for (const DepthRow& row : depth_check(result)) {
    ++rows;
    differ += row.agrees ? 0U : 1U;
  }
  if (rows > 0) {
    lines.push_back(
        fmt::format("responses alone against full sessions: {} of {} numbers of the report agree",
                    rows - differ, rows));
  } else if (!result.in_full) {
    lines.emplace_back("responses alone were not checked against full sessions (power.check)");
  }
  return lines;
}

}  // namespace haptrial::analysis
