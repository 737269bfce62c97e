#pragma once

#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Information that answers transmit about stimuli, Σ p(s, a) log2(p(s, a) / (p(s) p(a))), by the
/// shares of the answers [bit]. From n answers it is too large by about
/// (stimuli - 1) (answers - 1) / (2 n ln 2), unless hardly any are wrong (Miller 1955); with five
/// times the number of cells that is below a seventh of a bit.
/// Source: Garner and Hake 1951, Psychological Review 58.
/// @param counts  (stimuli x answers) >= 0, rows of equal length
Defined<double> information_transfer(const std::vector<std::vector<int>>& counts);

}  // namespace haptrial::analysis
