#pragma once

#include <string>

#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis {

/// The tests of a design as JSON, in the form that they have in statistics.json.
std::string design_json(const DesignTests& tests);

}  // namespace haptrial::analysis
