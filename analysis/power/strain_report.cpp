#include "analysis/power/strain_report.h"

#include <fmt/format.h>

#include "analysis/power/power_words.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

void add_level_rows(const PowerResult& result, const std::string& name, Rows& rows) {
  for (const PowerCell& cell : result.nulls) {
    const TestCount count = cell.counts.of(result.watch);
    const CountBand band = binomial_band(count.made, result.alpha, kNullBand);
    rows.push_back({name, words_of(result, cell), fmt::format("{} of {}", count.rejected, count.made),
                    fmt::format("{} to {}", band.low, band.high),
                    level_words(level_in(cell, result.watch, result.alpha))});
  }
}

/// @param planned  the same cells where all goes as planned
void add_share_rows(const PowerResult& result, const std::vector<PowerCell>& planned,
                    const std::string& name, Rows& rows) {
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const CellCounts& counts = result.cells[i].counts;
    rows.push_back({name, words_of(result, result.cells[i]),
                    std::to_string(counts.replications - counts.of(result.watch).made),
                    share_words(counts.of(result.watch)),
                    share_words(planned[i].counts.of(result.watch))});
  }
}

}  // namespace

void add_strains(Document& report, const PowerResult& result) {
  if (result.strains.empty()) {
    return;
  }
  Rows levels, shares;
  std::vector<std::string> points;
  for (const PowerStrain& strain : result.strains) {
    if (!strain.refused.empty()) {
      points.push_back(fmt::format("{}: not simulated ({})", strain.name, strain.refused));
      continue;
    }
    const PowerResult strained = under(result, strain);
    add_level_rows(strained, strain.name, levels);
    add_share_rows(strained, result.cells, strain.name, shares);
    if (!is_power(strained)) {
      points.push_back(strain.name + ": " + verdict(strained));
    }
    for (const std::string& line : size_lines(strained)) {
      points.push_back(fmt::format("{}: {}", strain.name, line));
    }
  }
  report.heading("What may go wrong (simulated)");
  report.paragraph(
      "The same studies of the same virtual participants, with one thing at a time that a plan "
      "does not foresee. Levels: what the watched test rejects without an effect.");
  if (!points.empty()) {
    report.points(points);
  }
  if (!levels.empty()) {
    report.table({"What", "Cell", fmt::format("Below {}", result.alpha),
                  "99 % of tests that keep their level", "Finding"},
                 levels);
  }
  if (!shares.empty()) {
    report.table({"What", "Cell", "Test not made", "Share of rejections, 95 % interval",
                  "As planned"},
                 shares);
  }
}

}  // namespace haptrial::analysis
