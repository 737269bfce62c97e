#pragma once

#include <string>
#include <vector>

namespace haptrial::record {

/// The condition of a trial by the levels of its factors: joined by ", ". If they have more than
/// kConditionBytes, each is cut to its share of them, so that its beginning stays.
std::string condition_label(std::vector<std::string> levels);

}  // namespace haptrial::record
