#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::experiments {

/// @throws InputError for a session that is no drilling.
void require_drilling(const std::filesystem::path& file);

/// A procedure of an expert, and where it is.
struct ExpertSession {
  std::filesystem::path file;
  int trial{1};
  std::shared_ptr<const bone::BoneModel> bone;
  bool left_out{false};  // marked as bad, by the rule of the session's definition
  analysis::drilling::ExpertProcedure procedure;
};

/// Drillings of experts, each file once.
class ExpertSessions {
 public:
  /// @param bones  outlive this; equal bones of several files become one
  ExpertSessions(const analysis::drilling::SafeOptions& options,
                 analysis::drilling::StudyBones& bones)
      : options_(options), bones_(bones) {}

  /// Every procedure of a session, whoever that is.
  void add(const std::filesystem::path& file);
  /// The sessions of a study's expert groups; pilots are left out.
  /// @throws InputError where it has none, or they are of different definitions
  void add_study(const std::filesystem::path& folder);

  const std::vector<ExpertSession>& procedures() const { return procedures_; }
  /// Those that are not left out, as feedback takes them.
  std::vector<analysis::drilling::ExpertProcedure> for_feedback() const;

 private:
  analysis::drilling::SafeOptions options_;
  analysis::drilling::StudyBones& bones_;
  std::vector<ExpertSession> procedures_;
};

}  // namespace haptrial::experiments
