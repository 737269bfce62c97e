#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "experiments/plan/study_plan.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

/// The plan that a definition states, made now by whoever runs the program.
/// @param simulation  folder of `haptrial power simulate`, whose cells with the definition's number
///        of participants give the power; empty: that of the t test of [plan], if it states one
/// @throws InputError for a folder without a result, or of another study
StudyPlan make_plan(const Experiment& experiment, const std::filesystem::path& simulation);

/// Sentences on the power that a simulation found. @throws InputError as make_plan()
std::vector<std::string> simulated_power(const std::filesystem::path& simulation,
                                         const std::string& study, int participants);

/// The plan for people. @param plan  as it was read, with its digest
/// @param description  lines on what the definition asks for
analysis::Document preregistration(const StudyPlan& plan,
                                   const std::vector<std::string>& description);

/// Writes the plan as NAME.plan.json, .html and .md. A file that is there is never changed.
/// @returns whether it was written; false: the same plan is there
/// @throws InputError if the folder has another plan of this name, and says what differs, or for a
/// new plan whose data was to be kept until a day that is over
bool write_plan(const StudyPlan& plan, const std::filesystem::path& file,
                const std::vector<std::string>& description);

}  // namespace haptrial::experiments
