#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/document/palette.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

constexpr Look kMiddle{palette::kBlue, palette::kSolid, 7, 2.5, 1.0};
constexpr Look kBand{palette::kBlue, palette::kShort, 7, 1.2, 1.0};
constexpr Look kOne{palette::kBlack, palette::kSolid, 7, 1.0, 0.7};
constexpr Look kZero{palette::kOrange, palette::kSolid, 6, 1.2, 0.9};

std::string plain(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    word += u < 0x80 && (std::isalnum(u) != 0 || c == '-' || c == '_') ? c : '_';
  }
  return word;
}

Series pieces(const char* label, const Look& look, const std::vector<Segment>& segments) {
  Series series{label, Mark::kSegments, look};
  for (const auto& [from, to] : segments) {
    series.x.push_back(from.first);
    series.y.push_back(from.second);
    series.x2.push_back(to.first);
    series.y2.push_back(to.second);
  }
  return series;
}

/// Adds, at each place, an open circle for all its trials and a disc for those with the answer 1,
/// with areas as their numbers.
void add_answers(Figure& figure, const SurfaceCondition& one) {
  std::map<std::pair<double, double>, std::pair<int, int>> places;  // answers 1, all
  int most = 1;
  for (const SurfaceTrial& trial : one.trials) {
    auto& [ones, all] = places[{trial.stimulus[0], trial.stimulus[1]}];
    ones += trial.outcome == 1 ? 1 : 0;
    most = std::max(most, ++all);
  }
  const auto add = [&](const char* label, Look look, const std::pair<double, double>& place,
                       int count) {
    constexpr double kLargest = 3.0;  // of a place with the most trials
    look.point_size = kLargest * std::sqrt(static_cast<double>(count) / most);
    figure.series.push_back({label, Mark::kPoints, look, {place.first}, {place.second}});
  };
  bool first = true;
  for (const auto& [place, counts] : places) {
    add(first ? "all trials" : "", kZero, place, counts.second);
    if (counts.first > 0) {
      add(first ? "answer 1" : "", kOne, place, counts.first);
    }
    first = false;
  }
}

Figure figure_of(const TrialsResult& result, const SurfaceCondition& one) {
  Figure figure;
  figure.name = "surface-" + plain(one.participant) + "-" + plain(one.track) +
                (one.condition.empty() ? "" : "-" + plain(one.condition));
  figure.title = fmt::format("Threshold of {}{}{}", one.participant,
                             one.condition.empty() ? "" : ", ", one.condition);
  const std::string& unit = result.plan.function.axis.unit;
  const std::string in_unit = unit.empty() ? "" : " (" + unit + ")";
  figure.x_label = one.variables[0] + (one.shares_unit ? in_unit : "");
  figure.y_label = one.variables[1] + in_unit;
  figure.simulated = result.simulated();
  add_answers(figure, one);
  figure.series.push_back(pieces("threshold", kMiddle, one.contour->middle));
  figure.series.push_back(pieces("95 %", kBand, one.contour->sure));
  figure.series.push_back(pieces("", kBand, one.contour->hardly));
  std::erase_if(figure.series, [](const Series& s) { return s.x.empty(); });
  const std::string after = unit.empty() ? "" : " " + unit;
  for (const ContourPoint& point : one.points) {
    if (point.second.size() == 1) {
      figure.alt += fmt::format("{}{}{} at {} {:.4g}{}", figure.alt.empty() ? "" : "; ",
                                number(point.second.front()), after, one.variables[0], point.first,
                                one.shares_unit ? after : "");
    }
  }
  figure.caption = fmt::format(
      "Line: where the probability of the answer 1 is {:g} %; dashed: its 95 % band, point by "
      "point. Circles: the trials at each place; discs: those with the answer 1; areas as their "
      "numbers.",
      100.0 * one.share);
  return figure;
}

}  // namespace

std::vector<Figure> surface_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
  for (const SurfaceCondition& one : result.surfaces) {
    if (one.contour && one.no_contour.empty()) {
      figures.push_back(figure_of(result, one));
    }
  }
  return figures;
}

}  // namespace haptrial::analysis::trials
