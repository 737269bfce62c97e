#include "analysis/statistics/relation/roc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

struct Counts {
  double positives{0.0};
  double negatives{0.0};
};

Counts counted(std::span<const RocCase> cases) {
  Counts counts;
  for (const RocCase& c : cases) {
    (c.positive ? counts.positives : counts.negatives) += 1.0;
  }
  return counts;
}

std::vector<RocPoint> curve_of(std::span<const RocCase> cases, const Counts& counts) {
  std::vector<RocCase> falling(cases.begin(), cases.end());
  std::sort(falling.begin(), falling.end(),
            [](const RocCase& a, const RocCase& b) { return a.value > b.value; });
  std::vector<RocPoint> curve{{std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  Counts called;
  for (std::size_t i = 0; i < falling.size(); ++i) {
    (falling[i].positive ? called.positives : called.negatives) += 1.0;
    if (i + 1 == falling.size() || falling[i + 1].value < falling[i].value) {
      curve.push_back({falling[i].value, called.negatives / counts.negatives,
                       called.positives / counts.positives});
    }
  }
  return curve;
}

// The share of the other kind that a value lies on the right side of.
std::vector<double> placements(std::span<const RocCase> cases, const Counts& counts) {
  std::vector<double> result;
  for (const RocCase& c : cases) {
    double wins = 0.0;
    for (const RocCase& other : cases) {
      if (other.positive != c.positive) {
        const double lead = c.positive ? c.value - other.value : other.value - c.value;
        wins += lead > 0.0 ? 1.0 : lead == 0.0 ? 0.5 : 0.0;
      }
    }
    result.push_back(wins / (c.positive ? counts.negatives : counts.positives));
  }
  return result;
}

// A cluster's placements less the area, each kind by itself.
struct Deviation {
  double positive{0.0};
  double negative{0.0};
  bool has_positive{false};
  bool has_negative{false};
};

Defined<RocInterval> interval_of(std::span<const RocCase> cases, const Counts& counts, double area,
                                 double level) {
  const std::vector<double> placed = placements(cases, counts);
  std::map<std::size_t, Deviation> clusters;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Deviation& d = clusters[cases[i].cluster];
    (cases[i].positive ? d.positive : d.negative) += placed[i] - area;
    (cases[i].positive ? d.has_positive : d.has_negative) = true;
  }
  double of_positive = 0.0, of_negative = 0.0, both = 0.0;
  double with_positive = 0.0, with_negative = 0.0;
  for (const auto& [cluster, d] : clusters) {
    of_positive += d.positive * d.positive;
    of_negative += d.negative * d.negative;
    both += d.positive * d.negative;
    with_positive += d.has_positive ? 1.0 : 0.0;
    with_negative += d.has_negative ? 1.0 : 0.0;
  }
  if (with_positive < 2.0 || with_negative < 2.0) {
    return Undefined{"an interval takes two of each kind"};
  }
  const double m = counts.positives, n = counts.negatives;
  const auto all = static_cast<double>(clusters.size());
  const double variance = with_positive / (with_positive - 1.0) * of_positive / (m * m) +
                          with_negative / (with_negative - 1.0) * of_negative / (n * n) +
                          2.0 * all / (all - 1.0) * both / (m * n);
  if (!(variance > 1e-24)) {
    return Undefined{"the values separate the kinds without overlap, so that nothing varies"};
  }
  const double z = normal_quantile(0.5 + 0.5 * level);
  RocInterval interval{.error = std::sqrt(variance)};
  interval.low = std::max(0.0, area - z * interval.error);
  interval.high = std::min(1.0, area + z * interval.error);
  interval.p = std::min(1.0, 2.0 * normal_upper_tail(std::abs(area - 0.5) / interval.error));
  return interval;
}

}  // namespace

Defined<Roc> roc(std::span<const RocCase> cases, double level) {
  const Counts counts = counted(cases);
  if (counts.positives == 0.0 || counts.negatives == 0.0) {
    return Undefined{"there are values of one kind only"};
  }
  for (const RocCase& c : cases) {
    if (!std::isfinite(c.value)) {
      return Undefined{"a value is not finite"};
    }
  }
  Roc result;
  result.curve = curve_of(cases, counts);
  for (std::size_t i = 1; i < result.curve.size(); ++i) {
    const RocPoint& a = result.curve[i - 1];
    const RocPoint& b = result.curve[i];
    result.area +=
        0.5 * (a.true_positives + b.true_positives) * (b.false_positives - a.false_positives);
  }
  result.interval = interval_of(cases, counts, result.area, level);
  return result;
}

Defined<Roc> roc(std::span<const double> positives, std::span<const double> negatives,
                 double level) {
  std::vector<RocCase> cases;
  for (const double value : positives) {
    cases.push_back({value, true, cases.size()});
  }
  for (const double value : negatives) {
    cases.push_back({value, false, cases.size()});
  }
  return roc(cases, level);
}

}  // namespace haptrial::analysis
