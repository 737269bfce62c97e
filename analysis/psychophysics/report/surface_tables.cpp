#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/files/delimited.h"
#include "analysis/psychophysics/report/report_surfaces.h"

namespace haptrial::analysis::trials {
namespace {

using Json = nlohmann::ordered_json;

Json known(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json parameters_json(const SurfaceFit& fit) {
  Json all = Json::array();
  for (const SurfaceParameter& p : fit.parameters) {
    all.push_back({{"name", p.name},
                   {"mean", p.mean},
                   {"standard_deviation", p.deviation},
                   {"low_95", p.low},
                   {"high_95", p.high},
                   {"cut_off_by_its_range", p.at_edge}});
  }
  return all;
}

Json points_json(const SurfaceCondition& one) {
  Json all = Json::array();
  for (const ContourPoint& point : one.points) {
    all.push_back({{"first", point.first},
                   {"second", point.second},
                   {"low_95", known(point.low)},
                   {"high_95", known(point.high)}});
  }
  return all;
}

Json placed_json(const SurfaceCondition& one) {
  Json all = Json::array();
  for (const PlacedThreshold& each : one.placed) {
    all.push_back({{"others", each.others},
                   {"threshold", known(each.median)},
                   {"low_95", known(each.low)},
                   {"high_95", known(each.high)}});
  }
  return all;
}

}  // namespace

std::string surfaces_csv(const TrialsResult& result) {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const char* name : {"participant", "track", "condition", "share", "first_variable", "first",
                           "second_variable", "second", "low", "high"}) {
    row.add(name);
  }
  row.end();
  for (const SurfaceCondition& one : result.surfaces) {
    for (const ContourPoint& point : one.points) {
      for (const double second : point.second) {
        row.add(one.participant).add(one.track).add(one.condition).add(one.share);
        row.add(one.variables[0]).add(point.first).add(one.variables[1]).add(second);
        row.add(point.low).add(point.high);
        row.end();
      }
    }
    for (const PlacedThreshold& each : one.placed) {
      const std::vector<std::string> others(one.variables.begin() + 1, one.variables.end());
      row.add(one.participant).add(one.track).add(one.condition).add(one.share);
      row.add(fmt::format("{}", fmt::join(others, ", ")));
      row.add(fmt::format("{}", fmt::join(each.others, ", ")));
      row.add(one.variables[0]).add(each.median).add(each.low).add(each.high);
      row.end();
    }
  }
  return text;
}

std::string surfaces_json(const TrialsResult& result) {
  Json all = Json::array();
  for (const SurfaceCondition& one : result.surfaces) {
    Json made{{"participant", one.participant}, {"track", one.track},
              {"condition", one.condition},     {"variables", one.variables},
              {"trials", one.trials.size()},    {"threshold_share", one.share}};
    if (one.fit) {
      made["parameters"] = parameters_json(*one.fit);
      made["threshold"] = one.placed.empty() ? points_json(one) : placed_json(one);
    } else {
      made["not_defined"] = one.fit.because();
    }
    if (!one.no_contour.empty()) {
      made["no_contour_because"] = one.no_contour;
    }
    all.push_back(std::move(made));
  }
  return all.dump();
}

}  // namespace haptrial::analysis::trials
