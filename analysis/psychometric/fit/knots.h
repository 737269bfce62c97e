#pragma once

#include <vector>

#include "core/psychometric/procedure/quest_tables.h"

namespace haptrial::analysis {

/// A parameter between the values that a definition lists. A place counts in knots: 1.5 is halfway
/// from the second to the third of the values in rising order.
class Knots {
 public:
  explicit Knots(const psychometric::QuestDimension& parameter);

  double last() const noexcept { return static_cast<double>(values_.size() - 1); }
  /// @param place  0 to last()
  double value(double place) const noexcept { return between(values_, place); }
  /// The prior's weight there, for equal steps of the place.
  double weight(double place) const noexcept { return between(weights_, place); }

 private:
  static double between(const std::vector<double>& of, double place) noexcept;

  std::vector<double> values_;   // rising
  std::vector<double> weights_;  // likewise
};

}  // namespace haptrial::analysis
