#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/ridge_drag.h"
#include "analysis/document/figure.h"

namespace haptrial::evaluation {

/// One renderer with one friction, over angles of the flanks and depths.
struct FailureMap {
  std::string renderer;  // its word
  double friction{0.0};
  double radius{0.0};  // of the tool [m]
  struct Cell {
    double flank{0.0};  // [rad]
    double depth{0.0};  // [m]
    RidgeResult result;
    RidgeLaw law;
  };
  std::vector<Cell> cells;

  int count(RidgeOutcome outcome) const;
};

/// A ridge of 2 mm under every renderer of make_renderer(): flanks of 5 to 85 degrees, depths of
/// 0.25 to 8 mm; the proxy with three frictions, and as a sphere of 0.5 mm beside Ruspini's. Takes
/// a few seconds. Source: Morris 2006, §7.5 (Figure 65), as a map.
std::vector<FailureMap> failure_maps();

/// The ridges of a map, without what became of them.
std::vector<FailureMap::Cell> failure_cells();

/// A map of any renderer. @param make  a renderer of the ridge, with this friction and radius
FailureMap failure_map(const std::string& renderer, double friction, double radius,
                       const std::function<std::unique_ptr<contact::Renderer>(const Ridge&)>& make);

/// Name of a map, such as "proxy, friction 0.3" or "ruspini, sphere".
std::string name_of(const FailureMap& map);
/// Outcomes over angle and depth, each with its colour and shape.
analysis::Figure failure_figure(const FailureMap& map);
/// A row for each cell.
std::string failure_csv(const std::vector<FailureMap>& maps);
/// A file that failure_csv() made of one map: its angles, depths and outcomes.
/// @throws InputError for another table, or one without a row for each of failure_cells().
FailureMap read_failures(const std::filesystem::path& file);

}  // namespace haptrial::evaluation
