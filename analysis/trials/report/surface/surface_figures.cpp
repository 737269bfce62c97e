#include <fmt/format.h>

#include <cctype>

#include "analysis/document/palette.h"
#include "analysis/statistics/words/wording.h"
#include "analysis/trials/report/surface/report_surfaces.h"

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

Series presented(const char* label, const Look& look, const SurfaceCondition& one,
                 std::size_t outcome) {
  Series series{label, Mark::kPoints, look};
  for (const SurfaceTrial& trial : one.trials) {
    if (trial.outcome == outcome) {
      series.x.push_back(trial.stimulus[0]);
      series.y.push_back(trial.stimulus[1]);
    }
  }
  return series;
}

Figure figure_of(const TrialsResult& result, const SurfaceCondition& one) {
  Figure figure;
  figure.name = "surface-" + plain(one.participant) + "-" + plain(one.track) +
                (one.condition.empty() ? "" : "-" + plain(one.condition));
  figure.title = fmt::format("Threshold of {}{}{}", one.participant,
                             one.condition.empty() ? "" : ", ", one.condition);
  figure.x_label = one.variables[0];
  figure.y_label = one.variables[1];
  figure.simulated = result.simulated();
  figure.series = {presented("answer 1", kOne, one, 1), presented("answer 0", kZero, one, 0),
                   pieces("threshold", kMiddle, one.contour->middle),
                   pieces("95 %", kBand, one.contour->sure),
                   pieces("", kBand, one.contour->hardly)};
  std::erase_if(figure.series, [](const Series& s) { return s.x.empty(); });
  for (const ContourPoint& point : one.points) {
    if (point.second.size() == 1) {
      figure.alt +=
          fmt::format("{}{} at {} {}", figure.alt.empty() ? "" : "; ", number(point.second.front()),
                      one.variables[0], number(point.first));
    }
  }
  figure.caption = fmt::format(
      "Line: where the probability of the answer 1 is {:g} %; dashed: its 95 % band, point by "
      "point. Points: the answers, each at what was presented.",
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
