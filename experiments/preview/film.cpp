#include "experiments/preview/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/document/html.h"
#include "analysis/document/palette.h"
#include "experiments/preview/preview_page.h"
#include "experiments/preview/preview_pictures.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
namespace palette = analysis::palette;

constexpr double kFilmWide = 900.0, kFilmSide = 430.0, kFilmTop = 26.0;  // [px]
constexpr const char* kFilmFont = "font-family=\"Helvetica,Arial,sans-serif\"";

/// Looks of objects, one after the other.
constexpr std::array<const char*, 4> kColours{palette::kBlue, palette::kGreen, palette::kPurple,
                                              palette::kBlack};

/// The extent of what is shown.
struct Extent {
  Vector3d low{Vector3d::Constant(1e9)}, high{Vector3d::Constant(-1e9)};

  void take(const Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void take(const std::vector<SpaceObject>& objects) {
    for (const SpaceObject& object : objects) {
      for (const auto& [from, to] : object.lines) {
        take(from);
        take(to);
      }
    }
  }
  Vector3d middle() const { return 0.5 * (low + high); }
  double size() const { return std::max(0.02, (high - low).maxCoeff()); }
};

/// A view along an axis: place x, y on the picture of a point p_W.
struct Panel {
  const char* title;
  int across, up;
  double x, y, scale, up_scale;

  double px(const Vector3d& p) const { return x + scale * p[across]; }
  double py(const Vector3d& p) const { return y + up_scale * p[up]; }
};

std::array<Panel, 2> panels_of(const Extent& extent) {
  const double scale = (kFilmSide - 60.0) / extent.size();
  const Vector3d middle = extent.middle();
  const auto panel = [&](const char* title, int up, double left, double sign) {
    return Panel{title,
                 0,
                 up,
                 left + 0.5 * kFilmSide - scale * middle.x(),
                 kFilmTop + 0.5 * kFilmSide - sign * scale * middle[up],
                 scale,
                 sign * scale};
  };
  return {panel("from the front (x, y)", 1, 0.0, -1.0),
          panel("from above (x, z)", 2, kFilmWide - kFilmSide, 1.0)};
}

std::string film_text(double x, double y, const std::string& more, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {} font-size=\"14\" fill=\"{}\" {}>{}</text>",
                     x, y, kFilmFont, palette::kBlack, more, analysis::escape_html(words));
}

std::string path_of(const SpaceObject& object, const Panel& panel) {
  std::string d;
  for (const auto& [from, to] : object.lines) {
    d += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", panel.px(from), panel.py(from), panel.px(to),
                     panel.py(to));
  }
  return d;
}

std::string way_of(const VirtualTrial& trial, const Panel& panel) {
  const std::size_t step = std::max<std::size_t>(1, trial.times.size() / 600);
  std::string points;
  for (std::size_t i = 0; i < trial.times.size(); i += step) {
    points +=
        fmt::format("{:.1f},{:.1f} ", panel.px(trial.positions[i]), panel.py(trial.positions[i]));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#8a8f94\"/>", points);
}

/// A line with a head, from the hand along its force.
std::string arrow_path(double x, double y, double along, double up) {
  const double length = std::hypot(along, up);
  if (length < 1.0) {
    return "";
  }
  const double head = std::min(9.0, 0.5 * length) / length;
  const double tip_x = x + along, tip_y = y + up;
  const double neck_x = tip_x - 1.4 * head * along, neck_y = tip_y - 1.4 * head * up;
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", x,
                     y, neck_x, neck_y, tip_x, tip_y, neck_x - 0.6 * head * up,
                     neck_y + 0.6 * head * along, neck_x + 0.6 * head * up,
                     neck_y - 0.6 * head * along);
}

const VirtualStage* stage_at(const VirtualTrial& trial, double time) {
  const VirtualStage* found = nullptr;
  for (const VirtualStage& stage : trial.stages) {
    found = stage.begin <= time ? &stage : found;
  }
  return found;
}

std::string sentence_at(const VirtualTrial& trial, std::size_t sample) {
  const VirtualStage* stage = stage_at(trial, trial.times[sample]);
  const Vector3d& f = trial.forces[sample];
  return fmt::format("{:.2f} s{}: {:.2f} N (x {:.2f}, y {:.2f}, z {:.2f})", trial.times[sample],
                     stage == nullptr ? "" : ", " + stage->name, f.norm(), f.x(), f.y(), f.z());
}

/// The strongest force that is drawn [px].
constexpr double kLongestArrow = 110.0;

std::string text_of(const json& data) {
  return data.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Everything that the script needs, as JSON. Times [s], places [m], forces [N].
std::string data_of(const VirtualTrial& trial, const std::array<Panel, 2>& panels, double pixels,
                    std::size_t begin, const std::string& language) {
  constexpr std::size_t kMostFrames = 2400;
  const std::size_t step = std::max<std::size_t>(1, trial.times.size() / kMostFrames);
  std::string numbers;
  for (std::size_t i = 0; i < trial.times.size(); i += step) {
    numbers += fmt::format("{}{:.3f},{:.5f},{:.5f},{:.5f},{:.3f},{:.3f},{:.3f}",
                           numbers.empty() ? "" : ",", trial.times[i], trial.positions[i].x(),
                           trial.positions[i].y(), trial.positions[i].z(), trial.forces[i].x(),
                           trial.forces[i].y(), trial.forces[i].z());
  }
  json stages = json::array();
  for (const VirtualStage& stage : trial.stages) {
    stages.push_back({{"name", stage.name}, {"interval", stage.interval}, {"begin", stage.begin}});
  }
  json views = json::array();
  for (const Panel& panel : panels) {
    views.push_back({{"x", panel.x},
                     {"y", panel.y},
                     {"scale", panel.scale},
                     {"up_scale", panel.up_scale},
                     {"across", panel.across},
                     {"up", panel.up}});
  }
  const json rest{{"stages", stages},
                  {"panels", views},
                  {"pixels", pixels},
                  {"begin", trial.times[begin]},
                  {"words",
                   {{"play", in_language("Play", language)},
                    {"pause", in_language("Pause", language)},
                    {"time", in_language("Time in the trial", language)},
                    {"speed", in_language("Speed", language)}}}};
  return "{\"frames\":[" + numbers + "]," + text_of(rest).substr(1);
}

std::string metadata(const char* name, const std::string& data) {
  return fmt::format("<metadata class=\"{}\">{}</metadata>", name, analysis::escape_html(data));
}

std::string film_opening(double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\"><rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>",
      kFilmWide, height);
}

std::string panel_svg(const VirtualTrial& trial, const std::vector<SpaceObject>& objects,
                      const Panel& panel, double pixels, std::size_t sample) {
  const VirtualStage* stage = stage_at(trial, trial.times[sample]);
  const int interval = stage == nullptr ? 0 : stage->interval;
  std::string svg =
      film_text(panel.across == 0 && panel.up == 1 ? 4.0 : kFilmWide - kFilmSide + 4.0, 16.0, "",
                panel.title);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const bool there = objects[i].interval == 0 || objects[i].interval == interval;
    svg += fmt::format(
        "<path class=\"film-object\" data-interval=\"{}\" visibility=\"{}\" d=\"{}\" fill=\"none\" "
        "stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"0.6\"/>",
        objects[i].interval, there ? "visible" : "hidden", path_of(objects[i], panel),
        kColours[i % kColours.size()]);
  }
  svg += way_of(trial, panel);
  const double x = panel.px(trial.positions[sample]), y = panel.py(trial.positions[sample]);
  const Vector3d& force = trial.forces[sample];
  const double sign = panel.up_scale < 0.0 ? -1.0 : 1.0;
  svg +=
      fmt::format("<circle class=\"film-hand\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" fill=\"{}\"/>",
                  x, y, palette::kBlack);
  svg += fmt::format(
      "<path class=\"film-arrow\" d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"3\"/>",
      arrow_path(x, y, pixels * force[panel.across], sign * pixels * force[panel.up]),
      palette::kOrange, palette::kOrange);
  return svg;
}

}  // namespace

std::string film_svg(const VirtualTrial& trial, const std::vector<SpaceObject>& objects,
                     const std::string& language) {
  Extent extent;
  extent.take(objects);
  std::size_t strongest = 0;
  for (std::size_t i = 0; i < trial.times.size(); ++i) {
    extent.take(trial.positions[i]);
    strongest = trial.forces[i].norm() > trial.forces[strongest].norm() ? i : strongest;
  }
  const std::array<Panel, 2> panels = panels_of(extent);
  const double most = trial.forces[strongest].norm();
  const double pixels = most > 0.0 ? kLongestArrow / most : 0.0;
  std::string svg = film_opening(kFilmTop + kFilmSide + 34.0);
  for (const Panel& panel : panels) {
    svg += panel_svg(trial, objects, panel, pixels, strongest);
  }
  svg += film_text(4.0, kFilmTop + kFilmSide + 22.0, "class=\"film-said\"",
                   sentence_at(trial, strongest));
  return svg + metadata("film", data_of(trial, panels, pixels, strongest, language)) + "</svg>\n";
}

namespace {

/// The view before anybody turns it [degree].
constexpr double kAbout = 30.0, kOver = 25.0;
constexpr double kTurnHigh = 460.0;  // [px]

/// From W to the picture, about its middle, as page/turn.js does.
Eigen::Vector2d turned(const Vector3d& p) {
  const double a = kAbout * std::numbers::pi / 180.0, b = kOver * std::numbers::pi / 180.0;
  const double depth = p.z() * std::cos(a) - p.x() * std::sin(a);
  return {p.x() * std::cos(a) + p.z() * std::sin(a), p.y() * std::cos(b) - depth * std::sin(b)};
}

std::string axes_svg() {
  std::string svg;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d end = 38.0 * turned(Vector3d::Unit(axis));
    const double x = 60.0 + end.x(), y = kTurnHigh - 60.0 - end.y();
    svg += fmt::format("<path class=\"turn-axis\" d=\"M60 {:g}L{:.1f} {:.1f}\" stroke=\"{}\"/>",
                       kTurnHigh - 60.0, x, y, palette::kBlack);
    svg += film_text(x + 4.0, y - 2.0, "class=\"turn-name\"",
                     kAxisNames[static_cast<std::size_t>(axis)]);
  }
  return svg;
}

}  // namespace

std::string turned_svg(const std::vector<SpaceObject>& objects, const std::string& language) {
  constexpr double kUnits = 1e4;  // of line_numbers() in a metre
  Extent extent;
  extent.take(objects);
  const Vector3d middle = extent.middle();
  const double scale = (kTurnHigh - 80.0) / (1.3 * extent.size());  // [px/m]
  std::string svg = film_opening(kTurnHigh) + axes_svg();
  json numbers = json::array();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    std::string d;
    for (const auto& [from, to] : objects[i].lines) {
      const Eigen::Vector2d a = scale * turned(from - middle), b = scale * turned(to - middle);
      d += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", 0.5 * kFilmWide + a.x(),
                       0.5 * kTurnHigh - a.y(), 0.5 * kFilmWide + b.x(), 0.5 * kTurnHigh - b.y());
    }
    const char* colour = kColours[i % kColours.size()];
    svg += fmt::format(
        "<path class=\"turn-object\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\"/>",
        d, colour);
    svg += fmt::format(
        "<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\" {} font-size=\"14\" fill=\"{}\">{}</text>",
        kFilmWide - 6.0, 20.0 + 18.0 * static_cast<double>(i), kFilmFont, colour,
        analysis::escape_html(objects[i].name));
    numbers.push_back(line_numbers(objects[i].lines));
  }
  const json data{
      {"objects", numbers},
      {"middle", {kUnits * middle.x(), kUnits * middle.y(), kUnits * middle.z()}},
      {"scale", scale / kUnits},
      {"about", kAbout},
      {"over", kOver},
      {"words",
       {{"about", in_language("Turn", language)}, {"over", in_language("Tilt", language)}}}};
  return svg + metadata("turn", text_of(data)) + "</svg>\n";
}

}  // namespace haptrial::experiments
