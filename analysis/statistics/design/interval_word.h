#pragma once

#include <string>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {

/// "3.438 [3.182, 3.693]" or "–", for tables.
std::string interval_word(const Defined<MeanInterval>& interval);

}  // namespace haptrial::analysis
