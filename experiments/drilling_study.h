#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/drilling/validity_study.h"
#include "experiments/bone_definition.h"
#include "experiments/study_files.h"

namespace haptrial::experiments {

/// A group of a study, in the order in which participants belong to them.
struct StudyGroup {
  std::string name;
  int participants{0};
  bool expert{false};  // every group but one that is called novices

  bool operator==(const StudyGroup&) const = default;
};

/// The [groups] of a definition's text, in its order; one group of everybody where it has none.
/// @throws InputError for a number of participants that is none.
std::vector<StudyGroup> study_groups(std::string_view definition, std::string_view file_name);

/// The group of a participant from the number at the end of the identifier: participants 1 to n
/// belong to the first group of n, those that follow to the next.
/// @throws InputError for a number beyond the last group, or none where there are several groups.
std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject);

/// What metrics need of a definition; the group is empty.
analysis::drilling::ProcedureSetup procedure_setup(const BoneDefinition& definition);
/// Of the definition in a session file.
analysis::drilling::ProcedureSetup procedure_setup(const record::SessionReader& session,
                                                   const std::vector<StudyGroup>& groups);

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
