#include "analysis/contact/demo_study/demo_study_figures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/document/palette.h"

namespace haptrial::evaluation {
namespace {

namespace palette = analysis::palette;
using Eigen::Vector3d;

constexpr double kMilli = 1e3;  // m to mm
constexpr analysis::Look kOut{palette::kBlue, palette::kSolid, 7, 2.2, 0.5};
constexpr analysis::Look kIn{palette::kOrange, palette::kLong, 5, 2.2, 0.5};
constexpr analysis::Look kFaint{palette::kGrey, palette::kSolid, 7, 1.0, 0.15};

/// Longest stretch in which the probe touches, from and to; of more than `most` samples those in
/// the middle.
std::pair<std::size_t, std::size_t> longest_contact(const std::vector<bool>& touching,
                                                    std::size_t most) {
  std::pair<std::size_t, std::size_t> longest{0, 0};
  std::size_t first = 0;
  for (std::size_t i = 0; i <= touching.size(); ++i) {
    if (i == touching.size() || !touching[i]) {
      if (i - first > longest.second - longest.first) {
        longest = {first, i};
      }
      first = i + 1;
    }
  }
  const std::size_t more =
      longest.second - longest.first - std::min(longest.second - longest.first, most);
  return {longest.first + more / 2, longest.second - (more + 1) / 2};
}

/// Points seen along an axis: on the other two, the longer one across.
struct Side {
  Vector3d across, up;

  void add(const Vector3d& p, analysis::Series& series) const {
    series.x.push_back(kMilli * across.dot(p));
    series.y.push_back(kMilli * up.dot(p));
  }
};

Side broad_side(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) {
    box.extend(p);
  }
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&](int a, int b) { return box.sizes()[a] > box.sizes()[b]; });
  return {Vector3d::Unit(axes[0]), Vector3d::Unit(axes[1])};
}

void mark_simulated(analysis::Figure& figure) {
  figure.simulated = true;
  figure.who = "RECORDING";
}

analysis::Series curve(const std::string& label, const analysis::Look& look,
                       const std::vector<DemoStudyRow>& rows) {
  analysis::Series series{label, analysis::Mark::kLine, look};
  for (const DemoStudyRow& r : rows) {
    series.x.push_back(std::log10(static_cast<double>(r.triangles)));
    series.y.push_back(r.normal_error);
  }
  return series;
}

}  // namespace

analysis::Figure trajectory_figure(const DemoStudyTables& t) {
  constexpr std::size_t kMost = 200, kJoined = 10;
  const PreparedContact& c = t.contact;
  const auto [first, end] = longest_contact(c.touching, kMost);
  Vector3d up = Vector3d::Zero();
  for (std::size_t i = first; i < end; ++i) {
    up += c.normal[i];
  }
  up.normalize();
  const Vector3d way = c.out[end - 1] - c.out[first];
  const Side side{(way - way.dot(up) * up).normalized(), up};
  analysis::Series out{"out-trajectory, on the surface", analysis::Mark::kLine, kOut};
  analysis::Series in{"in-trajectory", analysis::Mark::kLine, kIn};
  analysis::Series joined{"force / stiffness", analysis::Mark::kSegments, {palette::kGrey}};
  joined.look.width = 0.8;
  for (std::size_t i = first; i < end; ++i) {
    side.add(c.out[i] - c.out[first], out);
    side.add(c.in[i] - c.out[first], in);
    if (i % kJoined == 0) {
      joined.x.push_back(out.x.back());
      joined.y.push_back(out.y.back());
      joined.x2.push_back(in.x.back());
      joined.y2.push_back(in.y.back());
    }
  }
  analysis::Figure figure;
  figure.name = "figure-62";
  figure.title = "Out-trajectory and in-trajectory";
  figure.x_label = "along the way (mm)";
  figure.y_label = "along the normal (mm)";
  constexpr double kRoom = 2.0;  // above and below: a flat strip has no place for numbers [mm]
  figure.y_range = {{std::floor(*std::min_element(in.y.begin(), in.y.end()) - kRoom),
                     std::ceil(*std::max_element(out.y.begin(), out.y.end()) + kRoom)}};
  figure.series = {joined, out, in};
  figure.height = 0.6;
  figure.equal_scale = true;
  mark_simulated(figure);
  figure.caption = fmt::format(
      "{:.2f} s in the middle of the longest contact, from the side: each point of the "
      "in-trajectory lies below its partner on the surface by the normal force over {:.0f} N/m "
      "(the source's Figures 61 and 62).",
      static_cast<double>(end - first) / c.rate, c.stiffness);
  figure.alt = "Two lines side by side, joined by short strokes along the normal.";
  return figure;
}

analysis::Figure path_figure(const DemoStudyTables& t) {
  constexpr std::size_t kDots = 2500;  // of each series
  const Side side = broad_side(t.scan);
  analysis::Series scan{"scan", analysis::Mark::kPoints, kFaint};
  for (std::size_t i = 0; i < t.scan.size(); i += 1 + t.scan.size() / kDots) {
    side.add(t.scan[i], scan);
  }
  analysis::Series path{"path in contact", analysis::Mark::kPoints, kOut};
  for (std::size_t i = 0; i < t.contact.out.size(); i += 1 + t.contact.out.size() / kDots) {
    if (t.contact.touching[i]) {
      side.add(t.contact.out[i], path);
    }
  }
  analysis::Figure figure;
  figure.name = "figure-63";
  figure.title = "The duck and the way of the probe";
  figure.x_label = "x (mm)";
  figure.y_label = "y (mm)";
  figure.series = {scan, path};
  figure.height = 0.7;
  figure.equal_scale = true;
  mark_simulated(figure);
  figure.caption = "Points of the scan and of the contact, seen from the side.";
  figure.alt = "A cloud of points in the shape of a toy duck with a path over it.";
  return figure;
}

analysis::Figure resolution_figure(const DemoStudyTables& t) {
  analysis::Figure figure;
  figure.name = "figure-64";
  figure.title = "Force error over the size of the mesh";
  figure.x_label = "triangles";
  figure.y_label = "error of the normal force (N)";
  for (const DemoStudyRow& r : t.table6) {
    figure.x_names.emplace_back(std::log10(static_cast<double>(r.triangles)),
                                fmt::format("{:.3g}k", 1e-3 * static_cast<double>(r.triangles)));
  }
  figure.series = {
      curve("plain", {palette::kBlue, palette::kSolid, 7, 2.2, 1.0}, t.table6),
      curve("force shading", {palette::kOrange, palette::kLong, 5, 2.2, 1.0}, t.shaded)};
  analysis::Series source{
      "source, plain", analysis::Mark::kPoints, {palette::kBlack, palette::kSolid, 6, 1.6, 1.2}};
  source.x = figure.series[0].x;
  source.y.assign(kSourceTable6.begin(), kSourceTable6.end());
  figure.series.push_back(source);
  figure.height = 0.5;
  mark_simulated(figure);
  figure.caption =
      "Root mean square of what the rendered force misses of the recorded normal "
      "force, for the proxy without friction.";
  figure.alt = "Error falls with the number of triangles, sooner with force shading.";
  return figure;
}

}  // namespace haptrial::evaluation
