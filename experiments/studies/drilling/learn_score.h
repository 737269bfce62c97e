#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "analysis/bone_drilling/feedback/score.h"

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

}  // namespace haptrial::experiments
