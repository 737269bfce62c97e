#include "analysis/psychophysics/report/report_surfaces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/files/delimited.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostShown = 4;  // pictures; the others lie beside the report

std::string condition_name(const SurfaceCondition& one) {
  return one.condition.empty()
             ? fmt::format("{}, {}", one.participant, one.track)
             : fmt::format("{}, {}, {}", one.participant, one.track, one.condition);
}

void add_parameters(Document& document, const std::vector<SurfaceCondition>& surfaces) {
  Rows rows;
  for (const SurfaceCondition& one : surfaces) {
    if (!one.fit) {
      rows.push_back({condition_name(one), std::to_string(one.trials.size()),
                      "not defined, because " + one.fit.because(), "–", "–", "–"});
      continue;
    }
    for (const SurfaceParameter& p : one.fit->parameters) {
      rows.push_back({condition_name(one), std::to_string(one.fit->trials), p.name, number(p.mean),
                      fmt::format("{} to {}", number(p.low), number(p.high)),
                      p.at_edge ? "cut off by its range" : ""});
    }
  }
  if (!rows.empty()) {
    document.table({"participant", "trials", "parameter", "posterior mean", "95 %", ""}, rows,
                   "Every participant's parameters");
  }
}

std::string end_words(double value) { return std::isnan(value) ? "open" : number(value); }

std::string second_of(const ContourPoint& point) {
  if (point.second.empty()) {
    return "none in the range";
  }
  std::vector<std::string> values;
  for (const double each : point.second) {
    values.push_back(number(each));
  }
  if (values.size() > 1) {
    return fmt::format("{}", fmt::join(values, " and "));
  }
  return fmt::format("{} [{}, {}]", values.front(), end_words(point.low), end_words(point.high));
}

/// @param unit  of both variables; empty if the definition states none
void add_points(Document& document, const std::vector<SurfaceCondition>& surfaces,
                const std::string& unit) {
  const std::string in_unit = unit.empty() ? "" : kNoBreak + unit;
  for (const SurfaceCondition& one : surfaces) {
    if (one.fit && !one.no_contour.empty()) {
      document.paragraph(fmt::format("{}: there is no threshold contour, because {}.",
                                     condition_name(one), one.no_contour));
    }
  }
  Rows rows;
  std::vector<std::string> heading;
  for (const SurfaceCondition& one : surfaces) {
    if (!one.fit || !one.no_contour.empty()) {
      continue;
    }
    for (const ContourPoint& point : one.points) {
      rows.push_back({condition_name(one),
                      fmt::format("{} = {:.4g}{}", one.variables[0], point.first,
                                  one.shares_unit ? in_unit : ""),
                      one.variables[1], second_of(point)});
    }
  }
  if (!rows.empty()) {
    document.table({"participant", "at", "threshold of",
                    unit.empty() ? "level [95 %]" : fmt::format("level [95 %] ({})", unit)},
                   rows, "The threshold over both variables");
  }
}

/// Thresholds over several other variables, at a few of their levels.
void add_placed(Document& document, const std::vector<SurfaceCondition>& surfaces) {
  Rows rows;
  for (const SurfaceCondition& one : surfaces) {
    for (const PlacedThreshold& each : one.placed) {
      std::string at;
      for (std::size_t k = 0; k < each.others.size(); ++k) {
        at += fmt::format("{}{} = {:.4g}", at.empty() ? "" : ", ", one.variables[k + 1],
                          each.others[k]);
      }
      rows.push_back(
          {condition_name(one), at, one.variables.front(),
           fmt::format("{} [{}, {}]",
                       std::isnan(each.median) ? "none in the range" : number(each.median),
                       end_words(each.low), end_words(each.high))});
    }
  }
  if (!rows.empty()) {
    document.table({"participant", "at", "threshold of", "level [95 %]"}, rows,
                   "The threshold over all variables");
  }
}

std::string method_of(const std::vector<SurfaceCondition>& surfaces) {
  const bool formula = std::ranges::any_of(surfaces, [](const SurfaceCondition& one) {
    return one.fit && !one.fit->parameters.empty();
  });
  return formula
             ? "The definition's own formula is fitted over all its variables: the posterior of "
               "its "
               "parameters from every answer, with the definition's priors, between the lowest and "
               "the highest value that it lists. Intervals are the central 95 % of the posterior."
             : "No formula is assumed: the threshold is a smooth function of the other variables, "
               "a "
               "Gaussian process whose smoothness is learnt from the answers. Intervals are the "
               "central 95 % of what is believed after every answer.";
}

}  // namespace

void add_surfaces(Document& document, const TrialsResult& result,
                  const std::vector<Drawing>& drawings) {
  std::size_t shown = 0, others = 0;
  for (const Drawing& drawing : drawings) {
    if (drawing.figure.name.starts_with("surface-")) {
      shown < kMostShown ? document.picture(drawing) : static_cast<void>(++others);
      shown += shown < kMostShown ? 1 : 0;
    }
  }
  if (others > 0) {
    document.paragraph(fmt::format("{} of other functions beside this report (surface-*.svg).",
                                   counted(others, "picture")));
  }
  add_parameters(document, result.surfaces);
  add_points(document, result.surfaces, result.plan.function.axis.unit);
  add_placed(document, result.surfaces);
  document.paragraph(
      method_of(result.surfaces) +
      fmt::format(
          " The threshold is where the probability of the answer 1 is {:g} %; its interval "
          "is that of "
          "one variable at one value of the other. \"Open\" is an end beyond the range."
          "{}",
          100.0 * (result.surfaces.empty() ? 0.5 : result.surfaces.front().share),
          result.plan.by.empty()
              ? ""
              : " Conditions are compared in the mean of each participant's threshold over "
                "the other variables, and over a single one in its slope by least squares."));
}

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
