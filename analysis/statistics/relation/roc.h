#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// One corner of a ROC curve: what the rule "positive from `threshold` up" gets right and wrong.
struct RocPoint {
  double threshold{0.0};        // infinite at the first corner: nothing is called positive
  double false_positives{0.0};  // share of the negatives
  double true_positives{0.0};   // share of the positives
};

/// The area under a ROC curve with its interval, which is cut off at 0 and 1.
struct RocInterval {
  double error{0.0};  // standard error
  double low{0.0};
  double high{0.0};
  double p{0.0};  // two-sided: the area is 0.5
};

/// How well a value tells positives (high) from negatives (low).
struct Roc {
  std::vector<RocPoint> curve;  // from (0, 0) to (1, 1)
  /// P(positive > negative) + P(equal) / 2.
  double area{0.0};
  Defined<RocInterval> interval{Undefined{""}};
};

/// Values that come from one cluster (a participant) depend on each other.
struct RocCase {
  double value{0.0};
  bool positive{false};
  std::size_t cluster{0};
};

/// Area by all pairs, ties half; its variance from the placements of every value among those of the
/// other kind (DeLong, DeLong and Clarke-Pearson 1988, Biometrics 44), summed over each cluster
/// first (Obuchowski 1997, Biometrics 53). With clusters of one both are the same.
/// Undefined without positives or negatives or with a value that is not finite. The interval is
/// undefined with fewer than two clusters of a kind, and where no placement varies, as after a
/// separation without overlap.
/// @param level  coverage of the interval, inside (0, 1).
Defined<Roc> roc(std::span<const RocCase> cases, double level = 0.95);

/// Every value on its own.
Defined<Roc> roc(std::span<const double> positives, std::span<const double> negatives,
                 double level = 0.95);

}  // namespace haptrial::analysis
