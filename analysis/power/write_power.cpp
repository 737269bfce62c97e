#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/staging.h"
#include "analysis/power/depth_check.h"
#include "analysis/power/power_report.h"
#include "analysis/power/power_words.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const RunningMean& mean) {
  return {{"replications", mean.count},
          {"mean", mean.mean},
          {"sd", mean.deviation()},
          {"standard_error", mean.error()}};
}

Json to_json(const TestCount& count, double alpha) {
  Json json{{"rejected", count.rejected}, {"made", count.made}};
  if (count.made > 0) {
    const Share share = share_of(count.rejected, count.made);
    const CountBand band = binomial_band(count.made, alpha, kNullBand);
    json.update({{"share", share.value},
                 {"low_95", share.low},
                 {"high_95", share.high},
                 {"null_band_99", {band.low, band.high}}});
  }
  return json;
}

Json to_json(const CellCounts& counts, double alpha) {
  Json tests = Json::object(), values = Json::object(), reasons = Json::object();
  for (const auto& [name, count] : counts.tests) {
    tests[name] = to_json(count, alpha);
  }
  for (const auto& [name, value] : counts.values) {
    values[name] = to_json(value);
  }
  for (const auto& [reason, count] : counts.reasons) {
    reasons[reason] = count;
  }
  return {{"replications", counts.replications},
          {"trials", counts.trials},
          {"hours_in_the_lab", counts.hours.mean},
          {"tests", tests},
          {"values", values},
          {"failures", reasons}};
}

Json to_json(const PowerResult& result, const PowerCell& cell) {
  Json levels = Json::object();
  for (std::size_t i = 0; i < result.keys.size(); ++i) {
    levels[result.keys[i].name] = cell.levels[i];
  }
  Json json{{"levels", levels}, {"studies", to_json(cell.counts, result.alpha)}};
  if (cell.sessions) {
    json["full_sessions"] = to_json(*cell.sessions, result.alpha);
  }
  return json;
}

Json to_json(const PowerResult& result, const std::vector<PowerCell>& cells) {
  Json all = Json::array();
  for (const PowerCell& cell : cells) {
    all.push_back(to_json(result, cell));
  }
  return all;
}

/// A field with a comma or a quotation mark in quotes.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

std::string csv_row(const PowerResult& result, const PowerCell& cell, const std::string& kind) {
  std::string row = field(kind);
  for (const double level : cell.levels) {
    row += fmt::format(",{}", level);
  }
  const TestCount count = cell.counts.of(result.watch);
  const Share share = count.made > 0 ? share_of(count.rejected, count.made) : Share{};
  const auto effect = cell.counts.values.find(result.watch);
  const bool known = effect != cell.counts.values.end();
  row += fmt::format(",{},{},{},", cell.counts.replications, count.made, count.rejected);
  row += count.made > 0 ? fmt::format("{},{},{},", share.value, share.low, share.high) : ",,,";
  row += known ? fmt::format("{},{},", effect->second.mean, effect->second.error()) : ",,";
  return row + fmt::format("{}\n", cell.counts.hours.mean);
}

}  // namespace

std::string power_csv(const PowerResult& result) {
  std::string csv = "simulated_cell";
  for (const PowerKey& key : result.keys) {
    csv += "," + field(key.name);
  }
  csv +=
      ",replications,made,rejected,share,low_95,high_95,effect,effect_standard_error,hours_in_the_"
      "lab\n";
  for (const PowerCell& cell : result.nulls) {
    csv += csv_row(result, cell, "no effect");
  }
  for (const PowerCell& cell : result.cells) {
    csv += csv_row(result, cell, "study");
  }
  return csv;
}

std::string power_json(const PowerResult& result) {
  Json check = Json::array();
  for (const DepthRow& row : depth_check(result)) {
    check.push_back({{"cell", row.cell},
                     {"value", row.value},
                     {"responses", to_json(row.responses)},
                     {"sessions", to_json(row.sessions)},
                     {"z", row.z},
                     {"agrees", row.agrees}});
  }
  Json json{{"simulated", true},
            {"experiment", result.title},
            {"watch", result.watch},
            {"alpha", result.alpha},
            {"target", result.target},
            {"depth", result.in_full ? "sessions" : "responses"},
            {"seed", result.seed},
            {"program", result.program},
            {"is_power", is_power(result)},
            {"verdict", verdict(result)},
            {"participants_needed", size_lines(result)},
            {"without_an_effect", to_json(result, result.nulls)},
            {"cells", to_json(result, result.cells)},
            {"depth_check", check}};
  return json.dump(1) + "\n";
}

void write_power(const PowerResult& result, const std::filesystem::path& folder) {
  const Staging staging(folder);
  staging.write("power.csv", power_csv(result));
  staging.write("power.json", power_json(result));
  Drawing drawing{power_figure(result), ""};
  draw_figures({drawing.figure}, staging.path());
  drawing.svg = file_text(staging.path() / "power.svg");
  const Document report = power_report(result, drawing);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis
