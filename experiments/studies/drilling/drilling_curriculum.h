#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "analysis/bone_drilling/feedback/score.h"
#include "experiments/study/next_case.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

/// A trainee's procedures that came to their end, in their order, with what their cases ask for.
/// @param sessions  finished ones of one participant, in their order
/// @param score     for criteria about it; null: nobody has one
/// @throws InputError for a file that is no drilling or damaged
std::vector<bone::CaseAttempt> case_attempts(const bone::Curriculum& curriculum,
                                             std::span<const std::filesystem::path> sessions,
                                             const analysis::drilling::ScoreModel* score);

/// The case that comes next. @param definition  with a curriculum  @param folder  of its file
NextCase next_case_of(const protocols::BoneDefinition& definition,
                      const std::filesystem::path& folder,
                      std::span<const std::filesystem::path> sessions);

/// Notes criteria about quantities that no procedure has.
/// @param definition  read from the same tables; null if it cannot be read
void check_curriculum(Table& root, const protocols::BoneDefinition* definition);

/// Checks criteria by the bone of each case. @param definition  with its bones
/// @throws InputError for a quantity that no procedure on that bone has, and for more bone left
/// than is measured
void check_criteria(const protocols::BoneDefinition& definition);

/// The score that a definition names, if its criteria ask for one.
std::optional<analysis::drilling::ScoreModel> score_for(const protocols::BoneDefinition& definition,
                                                        const std::filesystem::path& folder);

/// A class in one definition's curriculum: a page for a browser.
struct ClassRequest {
  std::filesystem::path definition;
  std::filesystem::path folder;  // of its session files
  std::filesystem::path out;     // new page (.html)
  bool overwrite{false};
};
/// @throws InputError for a definition without a curriculum, and where a page of that name exists
void write_class_page(const ClassRequest& request);

}  // namespace haptrial::experiments
