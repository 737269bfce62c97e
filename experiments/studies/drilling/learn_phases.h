#pragma once

#include <filesystem>
#include <optional>

#include "analysis/bone_drilling/phases/phase_labels.h"
#include "analysis/bone_drilling/phases/phase_model.h"

namespace haptrial::experiments {

/// The name of a model of phases within a study's folder, by which analyze divides its procedures.
inline constexpr const char* kPhasesFile = "phases.json";

struct PhasesRequest {
  std::filesystem::path study;   // folder of sessions; pilots and marked trials are left out
  std::filesystem::path labels;  // of read_phase_labels(); empty: what virtual surgeons worked on
  std::optional<int> number;     // of phases to be found without labels
  int threads{1};
};

struct LearnedPhases {
  analysis::drilling::PhaseModel model;  // procedures without a labelled action do not count
  double labelled{0.0};                  // share of actions that a label holds, with labels
  /// By models of other participants; undefined without labels.
  analysis::Defined<analysis::drilling::PhaseAccuracy> accuracy{analysis::Undefined{""}};
};

/// @throws InputError where sessions are of different definitions, nobody labelled, labels name
/// procedures that are not there, or there is too little of a phase.
LearnedPhases learn_study_phases(const PhasesRequest& request);

/// Divides procedures by the model of a file. @throws InputError as read_phase_model() does
analysis::drilling::FindPhases phases_by(const std::filesystem::path& file);

}  // namespace haptrial::experiments
