#include "experiments/drilled_procedure.h"

#include <fmt/format.h>

namespace haptrial::experiments {
namespace {

std::string clock(double seconds) {
  const auto whole = static_cast<long>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string injured(const analysis::drilling::LiveFigures& figures) {
  std::string list;
  for (const analysis::drilling::Injury& injury : figures.injuries) {
    if (injury.voxels + injury.crumbled > 0) {
      list += fmt::format("{} {} {}", list.empty() ? "" : ",", injury.structure,
                          injury.voxels + injury.crumbled);
    }
  }
  return list.empty() ? "nothing vital injured" : fmt::format("INJURED:{}", list);
}

}  // namespace

std::string line_of(const DrilledProcedure& procedure, bool simulated) {
  const analysis::drilling::LiveFigures& f = procedure.figures;
  return fmt::format(
      "{}{}: {}, drilling {}, {:.1f} mm3 of bone, {} voxels, {}{}{}",
      procedure.practice ? "practice" : fmt::format("procedure {}", procedure.trial),
      simulated ? " (SIMULATED)" : "", clock(f.time), clock(f.drilling), 1e9 * f.removed, f.voxels,
      f.visible_share ? fmt::format("{:.0f} % in sight, ", 100.0 * *f.visible_share) : "",
      f.mean_force ? fmt::format("{:.2f} N, ", *f.mean_force) : "", injured(f));
}

}  // namespace haptrial::experiments
