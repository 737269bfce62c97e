#include "experiments/studies/drilling/expert_sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/study/study_definitions.h"
#include "experiments/study/study_files.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"

namespace haptrial::experiments {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

void require_drilling(const fs::path& file) {
  if (!record::drills(record::SessionReader(file))) {
    throw InputError(fmt::format("{}: is not a drilling session", file.string()));
  }
}

void ExpertSessions::add(const fs::path& file) {
  const bool again = std::any_of(
      procedures_.begin(), procedures_.end(),
      [&file](const ExpertSession& expert) { return fs::equivalent(expert.file, file); });
  if (again) {
    return;  // named, and of the study as well
  }
  const record::SessionReader reader(file);
  const auto setup = procedure_setup(reader);
  const std::set<int> left_out = record::trials_left_out(reader);
  for (const drilling::Procedure& procedure : load_procedures(reader, setup, &bones_)) {
    procedures_.push_back({file, procedure.number, procedure.bone,
                           left_out.contains(procedure.number),
                           drilling::expert_procedure(procedure, options_, bones_)});
  }
}

void ExpertSessions::add_study(const fs::path& folder) {
  const std::size_t before = procedures_.size();
  std::vector<fs::path> experts;
  for (const fs::path& file : distinct_sessions(session_files(folder)).files) {
    const record::SessionReader reader(file);
    const record::SessionInfo& info = reader.info();
    if (info.pilot || !record::drills(reader)) {
      continue;
    }
    const auto groups =
        protocols::parse_bone_definition(info.definition, info.definition_name).groups;
    const std::string own = protocols::group_of(groups, info.subject);
    const bool expert = std::any_of(groups.begin(), groups.end(), [&own](const auto& group) {
      return group.expert && group.name == own;
    });
    if (expert) {
      experts.push_back(file);
    }
  }
  if (!experts.empty()) {
    static_cast<void>(definition_remarks(protocols::bone_drilling(), experts));
  }
  for (const fs::path& file : experts) {
    add(file);
  }
  if (procedures_.size() == before) {
    throw InputError(
        fmt::format("{}: holds no drilling of an expert; choose a study whose definition has "
                    "[groups], all but novices being experts",
                    folder.string()));
  }
}

std::vector<drilling::ExpertProcedure> ExpertSessions::for_feedback() const {
  std::vector<drilling::ExpertProcedure> procedures;
  for (const ExpertSession& each : procedures_) {
    if (!each.left_out) {
      procedures.push_back(each.procedure);
    }
  }
  return procedures;
}

}  // namespace haptrial::experiments
