#include "core/deformable/calibration/global_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/deformable/springs/compliance.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

/// Loads that only push, with their forces by vertex.
struct Pushed {
  const CalibrationLoad* load;
  Positions forces;
  double moved;  // root mean square of the reference's displacements [m]
};

std::vector<Pushed> pushed_loads(const CalibrationProblem& problem) {
  std::vector<Pushed> result;
  for (const CalibrationLoad& load : problem.loads()) {
    const bool moves = std::ranges::any_of(
        load.load.holds, [](const Hold& hold) { return !hold.displacement.isZero(0); });
    const double moved = distance_error(load.reference, problem.body().rest);
    if (moves || load.load.forces.empty() || moved == 0.0) {
      continue;
    }
    Positions forces(load.reference.size(), Vector3d::Zero());
    for (const NodalForce& nodal : load.load.forces) {
      forces[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
    result.push_back({&load, std::move(forces), moved});
  }
  return result;
}

/// The response at rest, which the best common scale divides.
std::optional<EvenStart> scaled_start(const SpringBody& body, const std::vector<Pushed>& loads,
                                      const ThreeLogarithms& ratios) {
  double along = 0.0, square = 0.0, all = 0.0;
  for (const Pushed& pushed : loads) {
    const auto response =
        small_displacements(body, pushed.load->load.holds, body.rest, pushed.forces);
    if (!response) {
      return std::nullopt;
    }
    for (std::size_t v = 0; v < response->size(); ++v) {
      const Vector3d u = (*response)[v] / pushed.moved;
      const Vector3d wanted = (pushed.load->reference[v] - body.rest[v]) / pushed.moved;
      along += u.dot(wanted);
      all += wanted.squaredNorm();
      square += u.squaredNorm();
    }
  }
  if (!(along > 0.0) || !std::isfinite(square)) {
    return std::nullopt;
  }
  EvenStart start{ratios, std::sqrt(std::max(0.0, 1.0 - along * along / (square * all)))};
  for (double& logarithm : start.logarithms) {
    logarithm += std::log10(square / along);
  }
  return start;
}

std::vector<ThreeLogarithms> all_ratios(const RatioGrid& grid) {
  const int most = grid.decades * grid.per_decade;
  std::vector<ThreeLogarithms> ratios;
  for (int area = -most; area <= most; ++area) {
    for (int volume = -most; volume <= most; ++volume) {
      ratios.push_back({0.0, static_cast<double>(area) / grid.per_decade,
                        static_cast<double>(volume) / grid.per_decade});
    }
  }
  std::ranges::stable_sort(
      ratios, {}, [](const ThreeLogarithms& r) { return std::abs(r[1]) + std::abs(r[2]); });
  return ratios;
}

}  // namespace

std::vector<EvenStart> global_starts(const CalibrationProblem& problem,
                                     const SpringParameters& parameters,
                                     std::span<const SearchRange> ranges, const RatioGrid& grid) {
  const std::vector<Pushed> loads = pushed_loads(problem);
  SpringBody body = problem.body();
  std::vector<EvenStart> starts;
  for (const ThreeLogarithms& ratios : all_ratios(grid)) {
    if (loads.empty()) {
      const double middle = 0.5 * (ranges[0].low + ranges[0].high);
      starts.push_back({{middle, middle + ratios[1], middle + ratios[2]}, 1.0});
      continue;
    }
    body.constants = parameters.constants(parameters.even(ratios));
    if (const auto start = scaled_start(body, loads, ratios)) {
      starts.push_back(*start);
    }
  }
  std::ranges::stable_sort(starts, {}, &EvenStart::left);
  for (EvenStart& start : starts) {
    for (double& logarithm : start.logarithms) {
      logarithm = std::clamp(logarithm, ranges[0].low, ranges[0].high);
    }
  }
  return starts;
}

}  // namespace haptrial::deformable
