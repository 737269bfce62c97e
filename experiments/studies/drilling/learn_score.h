#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/bone_drilling/feedback/score.h"
#include "core/bone/hint/safe_limits.h"

namespace haptrial::protocols {
struct BoneDefinition;
}

namespace haptrial::experiments {

/// Parts of a case besides its bone by the keys of a definition (ScoreModel::rules): all of its
/// tables of tools, cavity, osteotomy, tissue and forbidden regions; time limit, scale and greatest
/// force.
std::map<std::string, std::string> score_rules(const protocols::BoneDefinition& definition);

/// The score of a rated study, from its sessions and ratings; pilots and marked trials are left
/// out.
/// @throws InputError where sessions are of different definitions, nothing is rated or too few
/// participants are, or a file is damaged.
analysis::drilling::ScoreModel learn_study_score(const std::filesystem::path& folder);

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
