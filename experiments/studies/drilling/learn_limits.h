#pragma once

#include <filesystem>
#include <vector>

#include "core/bone/hint/safe_limits.h"

namespace haptrial::experiments {

/// Sessions from which safe values are learned.
struct LimitsRequest {
  std::vector<std::filesystem::path> experts;  // sessions
  std::filesystem::path study;                 // folder: those of its expert groups; empty: none
};

/// The safe limits that hints go by: of each vital structure and distance the values that 95 % of
/// the experts' removals stay below, as the trainee's page has them
/// (analysis/bone_drilling/feedback/safe_values.h).
/// @throws InputError where there are no experts, or none of them drilled near a vital structure.
hint::SafeLimits learn_limits(const LimitsRequest& request);

}  // namespace haptrial::experiments
