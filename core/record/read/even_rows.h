#pragma once

#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// Takes the last row of a block's stimulus away where it follows sooner than the others follow
/// each other: it is the end of the run, which need not lie on the even time base. For whoever
/// needs even rows; scores are defined over them, as in files of older versions, which lack that
/// row.
inline void keep_even(std::vector<StimulusRow>& rows) {
  constexpr double kRounding = 1e-6;  // of a step
  if (rows.size() < 3) {
    return;
  }
  const double step = rows[1].time - rows[0].time;
  const double last = rows.back().time - rows[rows.size() - 2].time;
  if (last < (1.0 - kRounding) * step) {
    rows.pop_back();
  }
}

}  // namespace haptrial::record
