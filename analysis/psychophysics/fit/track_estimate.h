#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis::trials {

/// A level that a track presented, and whether the track turned there.
struct TrackStep {
  std::size_t trial{0};  // in TrialsData::trials
  double applied{0.0};   // [unit of the variable]
  double outcome{0.0};   // 1 or 0, or a number that was given
  bool reversal{false};  // the next step goes against the last one
};

/// One track in one session, as it went and as it ended.
struct TrackEstimate {
  std::size_t session{0};  // in TrialsData::sessions
  std::string participant;
  std::string track;
  std::string variable;
  std::vector<TrackStep> steps;
  bool adaptive{false};                           // its procedure chose levels by the answers
  std::optional<double> target{};                 // share of answers 1 that the procedure seeks
  bool finished{false};                           // else it was broken off
  std::optional<psychometric::LevelRange> range;  // of what the procedure may present
  std::size_t at_end{0};  // steps at an end of the range, but for those before the first change
  std::vector<psychometric::Estimate> estimates;  // of the procedure itself
  std::string because;                            // why it states none
  std::string no_interval;                        // why the first estimate has no interval

  /// Whether the range, and not the answers, settled where the track was.
  bool ended_at_range() const { return 10 * at_end > steps.size(); }
};

/// A procedure as the definition begins it, by the name of a track; null: its levels are listed, or
/// it has several dimensions that nobody can replay.
using ProcedureOf = std::function<std::unique_ptr<psychometric::Procedure>(const std::string&)>;

/// Replays each track through its procedure. Trials of practice do not take part. Without a
/// procedure the track has steps, but no estimate; only a procedure that goes by steps has
/// reversals.
std::vector<TrackEstimate> track_estimates(const TrialsData& data, const ProcedureOf& procedure_of);

/// 95 % intervals of the estimates: what the procedure states itself (unless it is of the parameters
/// of a function that is fitted here, too, without the rates that its posterior assumes), Student's t if its error
/// has degrees of freedom, else track_interval() with the posterior of the track's own trials. That
/// one takes a function of the plan; without an interval the track says why.
void add_track_intervals(std::vector<TrackEstimate>& tracks, const TrialsPlan& plan,
                         const ProcedureOf& procedure_of, int threads);

}  // namespace haptrial::analysis::trials
