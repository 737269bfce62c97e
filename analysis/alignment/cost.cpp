// Cost of a path, summed in double precision.

#include "analysis/alignment/cost.h"
#include "analysis/alignment/error.h"

namespace haptrial::analysis {
namespace {

bool is_straight(PathPoint from, PathPoint to) {
  return to.target == from.target + 1 && to.applied == from.applied + 1;
}

template <class Power>
double sum_along(const CurveView& a, const CurveView& b, const AlignmentOptions& o,
                 std::span<const PathPoint> path, Power power) {
  const auto error = [&](PathPoint at) {
    const double force = a.force[at.target] - b.force[at.applied];
    const double slope = a.slope[at.target] - b.slope[at.applied];
    return o.force_weight * power(force) + o.slope_weight * power(slope);
  };
  const double straight_weight = doubles_straight(o.pattern) ? 2.0 : 1.0;
  double cost = path.empty() ? 0.0 : error(path[0]);
  for (std::size_t k = 1; k < path.size(); ++k) {
    cost += is_straight(path[k - 1], path[k]) ? straight_weight * error(path[k])
                                              : error(path[k]) + o.penalty;
  }
  return cost;
}

}  // namespace

double path_cost(const CurveView& target, const CurveView& applied, const AlignmentOptions& options,
                 std::span<const PathPoint> path) {
  return with_power(options.power,
                    [&](auto power) { return sum_along(target, applied, options, path, power); });
}

double path_weight(StepPattern pattern, std::span<const PathPoint> path) {
  std::size_t weight = path.size();
  if (doubles_straight(pattern)) {
    for (std::size_t k = 1; k < path.size(); ++k) {
      weight += is_straight(path[k - 1], path[k]);
    }
  }
  return static_cast<double>(weight);
}

}  // namespace haptrial::analysis
