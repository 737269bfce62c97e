#include "experiments/command/sessions/study_standing.h"

#include "core/base/definition/table.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {

std::optional<analysis::SequentialResult> study_standing(const Experiment& experiment,
                                                         const std::filesystem::path& folder,
                                                         int threads) {
  Table root = experiment.definition->root();
  const bool sequential = root.has("analysis") && root.table("analysis").has("sequential");
  if (!sequential || !holds_sessions(folder)) {
    return std::nullopt;
  }
  AnalysisRequest request;
  request.folder = folder;
  request.files = study_files(folder, Pilots::kLeftOut, protocol_of);
  request.threads = threads;
  return study_of(request.files.first).sequential(request);
}

bool has_ended(const std::optional<analysis::SequentialResult>& standing) {
  return standing && standing->verdict != analysis::SequentialVerdict::kGoOn;
}

std::vector<RosterNext> next_sessions(const Roster& roster,
                                      const std::optional<analysis::SequentialResult>& standing) {
  std::vector<RosterNext> next = roster.next;
  if (has_ended(standing)) {
    std::erase_if(next, [](const RosterNext& each) { return each.fresh; });
  }
  return next;
}

}  // namespace haptrial::experiments
