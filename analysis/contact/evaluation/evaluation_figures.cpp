#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/contact/evaluation/evaluation_report.h"
#include "analysis/document/palette.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::evaluation {
namespace {

using analysis::Figure;
using analysis::Look;
using analysis::Mark;
using analysis::Series;
namespace palette = analysis::palette;

constexpr double kShown = 4.0;             // of the forces over time [s]
constexpr std::size_t kMostPoints = 4000;  // of a curve
constexpr int kBins = 40;
constexpr std::array<Look, 4> kLooks{{{palette::kOrange, palette::kLong, 5, 1.6, 1.0},
                                      {palette::kBlue, palette::kMixed, 9, 1.6, 1.0},
                                      {palette::kGreen, palette::kShort, 11, 1.6, 1.0},
                                      {palette::kPurple, palette::kLong, 13, 1.6, 1.0}}};

/// The samples of the longest stretch of contact, at most kShown long.
std::pair<std::size_t, std::size_t> shown_samples(const PreparedContact& c) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (std::size_t i = 0; i < c.touching.size();) {
    std::size_t end = i;
    while (end < c.touching.size() && c.touching[end] == c.touching[i]) {
      ++end;
    }
    if (c.touching[i] && end - i > best.second - best.first) {
      best = {i, end};
    }
    i = end;
  }
  const auto most = static_cast<std::size_t>(kShown * c.rate);
  const std::size_t middle = (best.first + best.second) / 2;
  if (best.second - best.first > most) {
    best = {middle - most / 2, middle - most / 2 + most};
  }
  return best;
}

Series size_over_time(const std::string& label, const Look& look, const PreparedContact& c,
                      const std::vector<Eigen::Vector3d>& force, bool along) {
  Series series{label, Mark::kLine, look};
  const auto [first, end] = shown_samples(c);
  const std::size_t step = std::max<std::size_t>(1, (end - first) / kMostPoints);
  for (std::size_t i = first; i < end; i += step) {
    const double normal = force[i].dot(c.normal[i]);
    series.x.push_back(c.time[i]);
    series.y.push_back(along ? (force[i] - normal * c.normal[i]).norm() : normal);
  }
  return series;
}

/// The rendering with the least error, and the least without friction if that is another one.
std::vector<const EvaluatedRendering*> best_renderings(const Evaluation& e) {
  std::vector<const EvaluatedRendering*> sorted;
  for (const EvaluatedRendering& r : e.renderings) {
    sorted.push_back(&r);
  }
  const auto less = [](const auto* a, const auto* b) {
    return a->force.root_mean_square < b->force.root_mean_square;
  };
  std::sort(sorted.begin(), sorted.end(), less);
  std::vector<const EvaluatedRendering*> best{sorted.front()};
  for (const EvaluatedRendering* r : sorted) {
    if (best.front()->friction > 0.0 && r->friction == 0.0) {
      best.push_back(r);
      break;
    }
  }
  return best;
}

Figure force_figure(const Evaluation& e, bool along) {
  Figure figure;
  figure.name = along ? "force-along-surface" : "force-normal";
  figure.title = along ? "Size of the force along the surface" : "Force along the normal";
  figure.x_label = "time (s)";
  figure.y_label = "force (N)";
  figure.series.push_back(size_over_time("recorded",
                                         {palette::kBlack, palette::kSolid, 7, 2.2, 1.0}, e.contact,
                                         e.contact.force, along));
  std::size_t look = 0;
  for (const EvaluatedRendering* r : best_renderings(e)) {
    figure.series.push_back(
        size_over_time(name_of(*r), kLooks.at(look++), e.contact, r->rendered.force, along));
  }
  figure.height = 0.4;
  figure.caption = fmt::format(
      "The middle of the longest stretch of contact. Shown are the rendering with the least error "
      "and, if that one has friction, the best without.{}",
      along ? "" : " The in-trajectory is made from this force.");
  figure.alt = "Recorded and rendered force over time.";
  return figure;
}

Figure band_figure(const Evaluation& e) {
  Figure figure;
  figure.name = "error-by-band";
  figure.title = "Force error by band";
  figure.y_label = "root mean square (N)";
  figure.x_names = {{1.0, "below 10 Hz"}, {2.0, "10 to 100 Hz"}, {3.0, "above 100 Hz"}};
  figure.x_range = {0.5, 3.7};
  const std::array<const char*, 5> colors{palette::kOrange, palette::kBlue, palette::kGreen,
                                          palette::kPurple, palette::kBlack};
  const std::array<int, 5> points{5, 7, 9, 11, 13};
  for (std::size_t i = 0; i < e.renderings.size(); ++i) {
    const EvaluatedRendering& r = e.renderings[i];
    const Look look{colors[i % colors.size()], palette::kSolid,
                    points[i % points.size()] - (i >= points.size() ? 1 : 0), 1.5, 1.4};
    const double place =
        0.06 * (static_cast<double>(i) - 0.5 * static_cast<double>(e.renderings.size()));
    figure.series.push_back({name_of(r),
                             Mark::kPoints,
                             look,
                             {1.0 + place, 2.0 + place, 3.0 + place},
                             {r.bands.slow, r.bands.middle, r.bands.fast}});
  }
  figure.height = 0.5;
  figure.caption = "The squares of the three bands add up to the square of the whole error.";
  figure.alt = "The error of each renderer in three bands.";
  return figure;
}

Figure residual_figure(const Evaluation& e) {
  std::vector<double> distance;  // of recorded contacts outside the mesh [mm]
  const ContactSamples& s = e.contact.samples;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (s.force[i].dot(s.normal[i]) > e.contact.least_force) {
      distance.push_back(-1e3 * s.depth[i]);
    }
  }
  Figure figure;
  figure.name = "residual";
  figure.title = "Distance of the recorded contacts from the mesh";
  figure.x_label = "distance, positive outside (mm)";
  figure.y_label = "contacts";
  const double low = distance.empty() ? 0.0 : *analysis::quantile(distance, 0.002);
  const double high = distance.empty() ? 1.0 : *analysis::quantile(distance, 0.998);
  const double side = std::max((high - low) / kBins, 1e-6);
  Series series{"", Mark::kSegments, {palette::kBlue, palette::kSolid, 7, 6.0, 1.0}};
  for (int b = 0; b < kBins; ++b) {
    const double from = low + b * side;
    const auto count = std::count_if(distance.begin(), distance.end(),
                                     [&](double d) { return d >= from && d < from + side; });
    series.x.push_back(from + 0.5 * side);
    series.y.push_back(0.0);
    series.x2.push_back(from + 0.5 * side);
    series.y2.push_back(static_cast<double>(count));
  }
  figure.series = {series};
  figure.height = 0.4;
  figure.caption =
      "What the registration and the noise of the poses leave; 0.4 % of the contacts, "
      "the farthest, lie outside of the picture.";
  figure.alt = "Histogram of the distances.";
  return figure;
}

}  // namespace

std::vector<Figure> evaluation_figures(const Evaluation& e, const EvaluationNames& names) {
  std::vector<Figure> figures{force_figure(e, false), force_figure(e, true), band_figure(e),
                              residual_figure(e)};
  for (Figure& figure : figures) {
    figure.simulated = names.simulated;
    figure.who = "RECORDING";
  }
  return figures;
}

}  // namespace haptrial::evaluation
