#include "analysis/psychometric/models/errors_in_variables.h"

#include <cmath>
#include <limits>

namespace haptrial::analysis {
namespace {

/// Weighted means, and sums of squares and products around them.
struct Sums {
  double count{0.0}, x{0.0}, y{0.0};
  double xx{0.0}, yy{0.0}, xy{0.0};
};

Sums sums_of(std::span<const NoisyPoint> points) {
  Sums sums;
  for (const NoisyPoint& p : points) {
    sums.count += p.count;
    sums.x += p.count * p.x;
    sums.y += p.count * p.y;
  }
  sums.x /= sums.count;
  sums.y /= sums.count;
  for (const NoisyPoint& p : points) {
    sums.xx += p.count * (p.x - sums.x) * (p.x - sums.x);
    sums.yy += p.count * (p.y - sums.y) * (p.y - sums.y);
    sums.xy += p.count * (p.x - sums.x) * (p.y - sums.y);
  }
  return sums;
}

/// The variance of y - b x of one value.
double variance_along(const RepeatScatter& s, double slope) {
  return s.yy - 2.0 * slope * s.xy + slope * slope * s.xx;
}

double squares_beside(const Sums& s, double slope) {
  return s.yy - 2.0 * slope * s.xy + slope * slope * s.xx;
}

/// The derivative of squares / variance is 0 at the roots of a quadratic; the smaller ratio wins.
double best_slope(const Sums& s, const RepeatScatter& e) {
  const double a = s.xy * e.xx - s.xx * e.xy;
  const double b = s.xx * e.yy - s.yy * e.xx;
  const double c = s.yy * e.xy - s.xy * e.yy;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * c));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double first = q / a, second = c / q;
  const auto ratio = [&](double slope) {
    return std::isfinite(slope) ? squares_beside(s, slope) / variance_along(e, slope)
                                : std::numeric_limits<double>::infinity();
  };
  return ratio(first) < ratio(second) ? first : second;
}

/// Squares of the places along x at which the points most likely lie (York's adjusted points).
double adjusted_squares(std::span<const NoisyPoint> points, const Sums& s, const RepeatScatter& e,
                        double slope) {
  const double share = (slope * e.xx - e.xy) / variance_along(e, slope);
  double squares = 0.0;
  for (const NoisyPoint& p : points) {
    const double beside = (p.y - s.y) - slope * (p.x - s.x);
    const double place = (p.x - s.x) + share * beside;
    squares += p.count * place * place;
  }
  return squares;
}

}  // namespace

Defined<NoisyLine> noisy_line(std::span<const NoisyPoint> points, const RepeatScatter& scatter) {
  if (points.size() < 2) {
    return Undefined{"there are fewer than two points"};
  }
  if (!(scatter.xx > 0.0 && scatter.yy > 0.0 &&
        scatter.xy * scatter.xy < scatter.xx * scatter.yy)) {
    return Undefined{"repeated values do not scatter in both directions"};
  }
  const Sums s = sums_of(points);
  const auto df = static_cast<double>(points.size()) - 2.0;
  if (!(s.xx > (df + 1.0) * scatter.xx)) {
    return Undefined{"the levels differ no more than their errors explain"};
  }
  NoisyLine line;
  line.slope = best_slope(s, scatter);
  line.intercept = s.y - line.slope * s.x;
  line.df = df;
  line.error = df > 0.0 ? std::sqrt(squares_beside(s, line.slope) / df /
                                    adjusted_squares(points, s, scatter, line.slope))
                        : std::numeric_limits<double>::infinity();
  return std::isfinite(line.slope) ? Defined<NoisyLine>(line)
                                   : Undefined{"the line stands upright"};
}

}  // namespace haptrial::analysis
