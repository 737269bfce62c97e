#include "experiments/command/deform/calibration_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/document/html.h"
#include "core/render/gl/image.h"
#include "core/render/mesh/scene.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;
using Places = std::vector<Vector3d>;

constexpr render::Colour kBody{0.80, 0.78, 0.72};
constexpr render::Colour kGoodColour{0.93, 0.93, 0.90};   // no error
constexpr render::Colour kWorstColour{0.75, 0.10, 0.05};  // the largest

double largest_way(const Places& from, const Places& to) {
  double most = 0.0;
  for (std::size_t v = 0; v < from.size(); ++v) {
    most = std::max(most, (to[v] - from[v]).norm());
  }
  return most;
}

/// How much larger displacements are drawn: 1, 2, 5, 10, 20 ..., so that they can be seen.
double exaggeration(const Places& rest, const Places& reference) {
  constexpr double kSeen = 0.08;  // of the body's extent
  Vector3d low = rest.front(), high = low;
  for (const Vector3d& p : rest) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double wanted =
      kSeen * (high - low).norm() / std::max(largest_way(rest, reference), 1e-300);
  if (!(wanted > 1.0)) {
    return 1.0;
  }
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double digit : {5.0, 2.0}) {
    if (wanted >= digit * power) {
      return digit * power;
    }
  }
  return power;
}

render::Colour mixed(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {kGoodColour.red + s * (kWorstColour.red - kGoodColour.red),
          kGoodColour.green + s * (kWorstColour.green - kGoodColour.green),
          kGoodColour.blue + s * (kWorstColour.blue - kGoodColour.blue)};
}

/// @param most  the error of the darkest colour; 0: no colours
std::vector<render::SceneTriangle> scene_of(const deformable::SpringBody& body, const Places& at,
                                            const Places& reference, double times, double most) {
  std::vector<render::SceneTriangle> scene;
  for (const deformable::Face& face : body.parts.surface) {
    render::SceneTriangle triangle{{}, kBody, -1};
    double error = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(face[i]);
      triangle.corners[i] = body.rest[v] + times * (at[v] - body.rest[v]);
      error += (at[v] - reference[v]).norm() / 3.0;
    }
    if (most > 0.0) {
      triangle.colour = mixed(error / most);
    }
    scene.push_back(triangle);
  }
  return scene;
}

}  // namespace

std::vector<analysis::Drawing> calibration_pictures(const deformable::SpringBody& springs,
                                                    const JudgedLoad& load, std::size_t number,
                                                    const std::filesystem::path& folder) {
  const double times = exaggeration(springs.rest, load.at_reference);
  const std::string drawn =
      times > 1.0 ? fmt::format(" Displacements are drawn {:g} times as large.", times) : "";
  double most = 0.0;
  for (const Places* at : {&load.at_hand, &load.at_found}) {
    most = std::max(most, at->empty() ? 0.0 : largest_way(load.at_reference, *at));
  }
  render::SceneView view;
  view.up = Vector3d::UnitZ();
  view.edges = true;
  std::vector<analysis::Drawing> drawings;
  const auto draw = [&](const char* name, const std::string& what, const Places& at,
                        double colours) {
    if (at.empty()) {
      return;
    }
    analysis::Drawing drawing;
    drawing.figure.name = fmt::format("load-{}-{}", number, name);
    drawing.figure.title = fmt::format("{}: {}", load.name, what);
    drawing.figure.caption = fmt::format("{}: {}.{}", load.name, what, drawn);
    drawing.figure.alt = drawing.figure.title;
    const auto file = folder / (drawing.figure.name + ".png");
    render::write_png(
        file, render::draw_scene(scene_of(springs, at, load.at_reference, times, colours), view));
    drawing.svg = analysis::svg_of_png(file);
    drawings.push_back(std::move(drawing));
  };
  const std::string scale = fmt::format(", red for {:.3g} mm", 1e3 * most);
  draw("rest", "at rest", springs.rest, 0.0);
  draw("reference", "reference", load.at_reference, 0.0);
  draw("hand", "springs set by hand", load.at_hand, 0.0);
  draw("calibrated", "calibrated springs", load.at_found, 0.0);
  if (!load.markers && most > 0.0) {
    draw("hand-error", "error of the springs set by hand" + scale, load.at_hand, most);
    draw("calibrated-error", "error of the calibrated springs" + scale, load.at_found, most);
  }
  return drawings;
}

}  // namespace haptrial::experiments
