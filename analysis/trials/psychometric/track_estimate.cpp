#include "analysis/trials/psychometric/track_estimate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/psychometric/procedure/staircase.h"

namespace haptrial::analysis::trials {
namespace {

/// Marks the levels from which a track turned: the last of those on an extreme.
void mark_reversals(std::vector<TrackStep>& steps) {
  int direction = 0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const double change = steps[i + 1].applied - steps[i].applied;
    constexpr double kRounding = 1e-9;
    if (std::abs(change) <= kRounding * std::abs(steps[i].applied)) {
      continue;
    }
    const int now = change > 0.0 ? 1 : -1;
    steps[i].reversal = direction != 0 && now != direction;
    direction = now;
  }
}

void replay(TrackEstimate& track, const std::vector<psychometric::Level>& levels,
            psychometric::Procedure& procedure) {
  const auto* staircase = dynamic_cast<const psychometric::Staircase*>(&procedure);
  try {
    for (std::size_t i = 0; i < track.steps.size() && !procedure.finished(); ++i) {
      if (!std::isfinite(track.steps[i].outcome)) {
        continue;
      }
      const int before = staircase != nullptr ? staircase->state().reversals : 0;
      procedure.report(track.steps[i].outcome, levels[i]);
      if (staircase != nullptr) {  // its own count, which knows of bounds and of the last trial
        track.steps[i].reversal = staircase->state().reversals > before;
      }
    }
    track.estimates = procedure.estimates();
    if (track.estimates.empty()) {
      track.because = "there are too few trials";
    }
  } catch (const std::invalid_argument& error) {
    track.because = error.what();
  }
}

}  // namespace

std::vector<TrackEstimate> track_estimates(const TrialsData& data,
                                           const ProcedureOf& procedure_of) {
  std::vector<TrackEstimate> tracks;
  std::vector<std::vector<psychometric::Level>> levels;
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    const StudyTrial& trial = data.trials[i];
    if (!trial.counts() || trial.levels.empty()) {
      continue;
    }
    const GivenLevel& first = trial.levels.front();
    auto at = std::find_if(tracks.begin(), tracks.end(), [&](const TrackEstimate& t) {
      return t.session == trial.session && t.track == first.track;
    });
    if (at == tracks.end()) {
      tracks.push_back({trial.session,
                        data.session_of(trial).participant,
                        first.track,
                        first.variable,
                        {},
                        {},
                        ""});
      levels.emplace_back();
      at = tracks.end() - 1;
    }
    at->steps.push_back({i, first.applied, first.outcome, false});
    psychometric::Level level;
    for (const GivenLevel& each : trial.levels) {
      level.push_back(each.applied);
    }
    levels[static_cast<std::size_t>(at - tracks.begin())].push_back(std::move(level));
  }
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    mark_reversals(tracks[i].steps);
    const auto procedure = procedure_of ? procedure_of(tracks[i].track) : nullptr;
    if (procedure) {
      replay(tracks[i], levels[i], *procedure);
    } else {
      tracks[i].because = "its levels are listed";
    }
  }
  return tracks;
}

}  // namespace haptrial::analysis::trials
