#include "analysis/force_training/score/path_places.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/control/curve_tracker.h"

namespace haptrial::analysis {
namespace {
constexpr double kCell = 0.005;  // [s] at the path's speed: 80 µm at 1.6 cm/s
}

PathPlaces::PathPlaces(std::span<const record::StimulusRow> rows) {
  std::vector<Eigen::Vector3d> points;
  for (const record::StimulusRow& row : rows) {
    points.push_back(row.position);
    times_.push_back(row.time);
  }
  curve_ = std::make_unique<control::SampledCurve>(points);
}

HandPlaces PathPlaces::of(std::span<const Eigen::Vector3d> positions) const {
  HandPlaces places;
  control::CurveTracker tracker(*curve_);
  for (const Eigen::Vector3d& position : positions) {
    const control::CurvePlace& place = tracker.follow(position);
    const double from = times_[place.segment];
    places.along.push_back(from + place.t * (times_[place.segment + 1] - from));
    const Eigen::Vector3d apart = position - place.position;
    places.distance.push_back(std::hypot(apart.x(), apart.z()));
  }
  return places;
}

ForceCurve over_path(std::span<const double> along, std::span<const double> force,
                     double duration) {
  if (along.size() != force.size() || along.empty() || !(duration > 0.0)) {
    throw std::invalid_argument("over_path: as many forces as places, and a duration above 0");
  }
  const auto cells = std::max<std::size_t>(2, static_cast<std::size_t>(duration / kCell) + 1);
  std::vector<double> sum(cells, 0.0);
  std::vector<double> count(cells, 0.0);
  const double scale = static_cast<double>(cells - 1) / duration;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double at = std::clamp(along[i] * scale, 0.0, static_cast<double>(cells - 1));
    const auto cell = static_cast<std::size_t>(std::lround(at));
    sum[cell] += force[i];
    count[cell] += 1.0;
  }
  ForceCurve curve;
  curve.rate = scale;
  curve.force.resize(cells);
  std::size_t before = cells;  // the last cell that the hand was in
  for (std::size_t k = 0; k < cells; ++k) {
    if (count[k] == 0.0) {
      continue;
    }
    curve.force[k] = sum[k] / count[k];
    for (std::size_t gap = before < cells ? before + 1 : 0; gap < k; ++gap) {
      const double share = before < cells
                               ? static_cast<double>(gap - before) / static_cast<double>(k - before)
                               : 1.0;
      const double from = before < cells ? curve.force[before] : curve.force[k];
      curve.force[gap] = from + share * (curve.force[k] - from);
    }
    before = k;
  }
  std::fill(curve.force.begin() + static_cast<std::ptrdiff_t>(before) + 1, curve.force.end(),
            curve.force[before]);
  return curve;
}

}  // namespace haptrial::analysis
