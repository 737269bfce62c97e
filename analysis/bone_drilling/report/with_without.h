#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis::drilling {

/// A value of one procedure, in which something was given or not.
struct GivenValue {
  std::string participant;
  bool given{true};
  std::optional<double> value;  // none: not defined in this procedure
};

/// Each participant's mean with hints less the mean without, tested in pairs.
struct WithWithout {
  std::size_t participants{0};  // with both
  Defined<TTest> test{Undefined{""}};
};
WithWithout with_less_without(const std::vector<GivenValue>& values);

/// Words for difference, interval and test.
std::string difference_word(const WithWithout& c, const char* unit);

/// Whether there are values with and without it.
bool has_both(const std::vector<GivenValue>& values);

}  // namespace haptrial::analysis::drilling
