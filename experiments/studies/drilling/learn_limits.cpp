#include "experiments/studies/drilling/learn_limits.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {
namespace {

namespace drilling = analysis::drilling;

hint::SafeStructure limits_of(const drilling::SafeProfile& profile) {
  hint::SafeStructure structure{profile.structure, {}};
  for (const drilling::SafeBin& bin : profile.bins) {
    if (bin.force && bin.speed) {
      structure.intervals.push_back({bin.low, bin.high, bin.force->high, bin.speed->high});
    }
  }
  return structure;
}

std::string study_of(const std::filesystem::path& session) {
  const record::SessionInfo info = record::SessionReader(session).info();
  return protocols::parse_bone_definition(info.definition, info.definition_name).name;
}

}  // namespace

hint::SafeLimits learn_limits(const LimitsRequest& request) {
  if (request.experts.empty() && request.study.empty()) {
    throw InputError("nobody is named to learn from; name --study FOLDER or --expert SESSION");
  }
  const drilling::SafeOptions options;
  drilling::StudyBones bones;
  ExpertSessions sessions(options, bones);
  for (const std::filesystem::path& file : request.experts) {
    require_drilling(file);
    sessions.add(file);
  }
  if (!request.study.empty()) {
    sessions.add_study(request.study);
  }
  const drilling::Experts experts =
      drilling::experts_of(sessions.for_feedback(), /*without=*/"", options);
  hint::SafeLimits limits;
  limits.study = study_of(sessions.procedures().front().file);
  limits.participants = experts.participants.size();
  limits.procedures = experts.summaries.size();
  limits.share = options.high;
  limits.simulated = experts.simulated;
  for (const drilling::SafeProfile& profile : experts.profiles) {
    hint::SafeStructure structure = limits_of(profile);
    if (!structure.intervals.empty()) {
      limits.structures.push_back(std::move(structure));
    }
  }
  if (limits.structures.empty()) {
    throw InputError(fmt::format(
        "the experts' procedures have no {} removals in any interval of distance from a vital "
        "structure, so that nothing can be learned; name more of them",
        options.fewest));
  }
  return limits;
}

}  // namespace haptrial::experiments
