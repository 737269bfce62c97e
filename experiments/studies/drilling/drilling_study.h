#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/report/validity_study.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/study/study_files.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {

/// The name of the ratings within a study's folder.
inline constexpr const char* kRatingsFile = "ratings.csv";

/// Analyses drilling sessions.
/// @param folder  of the study, where its ratings are
/// @param out  folder for the report
/// @returns lines for the terminal
std::vector<std::string> analyze_drillings(const std::filesystem::path& folder,
                                           const StudyFiles& files,
                                           const std::filesystem::path& out, int threads);

}  // namespace haptrial::experiments
