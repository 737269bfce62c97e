#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/document/finding.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis::drilling {

/// One procedure of a session in which something was given or not: hints, a monitor of nerves,
/// forbidden regions. What would have been given is recorded in all of them.
struct GivenProcedure {
  std::string session;  // name of the file
  std::string participant;
  std::string group;
  std::string condition;
  int number{1};
  bool simulated{true};
  bool given{true};
  double drilling{0.0};  // the burr turned in bone [s]
};

/// @param condition  of the procedure's last pass that counts
/// @param what       as conditions name it, such as "hints"
GivenProcedure given_procedure(const ProcedureSummary& summary, const std::string& condition,
                               std::string_view what);

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

/// The difference with its interval, and p. @param name  their place in JSON
FindingRow difference_findings(const std::string& name, const std::string& title,
                               const std::string& unit, const WithWithout& c);

/// Words for difference, interval and test.
std::string difference_word(const WithWithout& c, const char* unit);

/// Whether there are values with and without it.
bool has_both(const std::vector<GivenValue>& values);

}  // namespace haptrial::analysis::drilling
