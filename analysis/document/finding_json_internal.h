#pragma once

#include <nlohmann/json_fwd.hpp>

#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// @throws nlohmann::json::exception for a name that is a value and a group at once
nlohmann::ordered_json json_of(const FindingRow& row);
nlohmann::ordered_json json_of(const std::vector<FindingRow>& rows);
/// Lists with values, by name; those that only have text are in the report alone.
nlohmann::ordered_json json_of(const std::vector<FindingList>& lists);

}  // namespace haptrial::analysis
