#pragma once

#include <utility>
#include <vector>

#include "analysis/psychometric/fit/surface_fit.h"

namespace haptrial::analysis {

/// A piece of a line, from the first point to the second: values of the two variables.
using Segment = std::pair<std::pair<double, double>, std::pair<double, double>>;

/// Curve on which a function of two variables reaches a probability.
struct Contour {
  double share{0.5};
  std::vector<Segment> middle;  // the posterior's median reaches it
  std::vector<Segment> sure;    // beyond it with 97.5 % of the posterior; and
  std::vector<Segment> hardly;  // with 2.5 %: point by point the ends of a 95 % band
};

/// The second variable at the threshold, for one value of the first.
struct ContourPoint {
  double first{0.0};
  std::vector<double> second;  // the middle line, rising; several if the line comes back
  double low{0.0}, high{0.0};  // ends of the band; NaN: beyond the range, or there are several
};

/// The posterior of the probability of the answer 1 at each point of a grid over the two variables'
/// ranges.
class ThresholdMap {
 public:
  /// @param definition  with two stimulus variables of several values each, and two outcomes
  /// @throws std::invalid_argument for others
  ThresholdMap(const psychometric::QuestDefinition& definition, const SurfaceFit& fit,
               double share);

  Contour contour() const;
  /// Points at evenly spaced values of the first variable, both ends among them.
  std::vector<ContourPoint> points(std::size_t count) const;

 private:
  using Map = std::vector<double>;  // (first x second) a quantile of the posterior
  std::vector<Segment> line(const Map& map) const;
  std::vector<double> crossings(double first, const Map& map) const;

  double share_;
  std::vector<double> first_, second_;  // rising values of the grid
  Map low_, middle_, high_;             // 2.5 %, 50 % and 97.5 %
};

}  // namespace haptrial::analysis
