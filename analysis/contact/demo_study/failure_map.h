#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/ridge_drag.h"
#include "analysis/document/figure.h"

namespace haptrial::evaluation {

/// One renderer with one friction, over angles of the flanks and depths.
struct FailureMap {
  contact::RendererKind kind{contact::RendererKind::kProxy};
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

/// Name of a map, such as "proxy, friction 0.3" or "ruspini, sphere".
std::string name_of(const FailureMap& map);
/// Outcomes over angle and depth, each with its colour and shape.
analysis::Figure failure_figure(const FailureMap& map);
/// A row for each cell.
std::string failure_csv(const std::vector<FailureMap>& maps);

}  // namespace haptrial::evaluation
