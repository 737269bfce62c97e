#pragma once

#include <string>
#include <vector>

#include "analysis/power/power_result.h"

namespace haptrial::analysis {

/// A number of the report from responses alone and from full sessions.
struct DepthRow {
  std::string cell;
  std::string value;
  RunningMean responses, sessions;
  double z{0.0};  // difference of the means by its standard error
  bool agrees{true};
};

/// Every number of every cell that was simulated in both ways. The bound of |z| is that of all rows
/// together at 99 % (Šidák), with Student's t of the smaller sample for full sessions are few.
std::vector<DepthRow> depth_check(const PowerResult& result);

}  // namespace haptrial::analysis
