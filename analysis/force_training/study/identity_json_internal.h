#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "analysis/force_training/study/identity.h"

namespace haptrial::analysis {

/// Identities as statistics.json has them.
nlohmann::ordered_json to_json(const std::vector<Identity>& identities);
/// @throws nlohmann::json::exception for what to_json() does not write.
std::vector<Identity> identities_from(const nlohmann::ordered_json& json);

}  // namespace haptrial::analysis
