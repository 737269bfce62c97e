#include "analysis/psychophysics/fit/track_estimate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/psychometric/fit/adaptive_posterior.h"
#include "analysis/psychometric/fit/track_interval.h"
#include "analysis/psychophysics/fit/function_fit.h"
#include "analysis/statistics/base/distributions.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

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

/// Counts steps at an end of the range; a track that begins there has not come to it.
std::size_t steps_at_end(const TrackEstimate& track) {
  if (!track.range || track.steps.empty()) {
    return 0;
  }
  const auto [low, high] = *track.range;
  const double close = 1e-9 * (high - low), first = track.steps.front().applied;
  const auto changed = std::ranges::find_if(
      track.steps, [&](const TrackStep& step) { return std::abs(step.applied - first) > close; });
  const auto at_end = [&](const TrackStep& step) {
    return step.applied <= low + close || step.applied >= high - close;
  };
  const bool stayed = changed == track.steps.end();
  return static_cast<std::size_t>(
      std::count_if(stayed ? track.steps.begin() : changed, track.steps.end(), at_end));
}

void replay(TrackEstimate& track, const std::vector<psychometric::Level>& levels,
            psychometric::Procedure& procedure) {
  try {
    for (std::size_t i = 0; i < track.steps.size() && !procedure.finished(); ++i) {
      if (!std::isfinite(track.steps[i].outcome)) {
        continue;
      }
      const auto before = procedure.counted_reversals();
      procedure.report(track.steps[i].outcome, levels[i]);
      if (before) {  // its own count, which knows of bounds and of the last trial
        track.steps[i].reversal = procedure.counted_reversals() > before;
      }
    }
    track.finished = procedure.finished();
    track.estimates = procedure.estimates();
    if (track.estimates.empty()) {
      track.because = "there are too few trials";
    }
  } catch (const std::invalid_argument& error) {
    track.because = error.what();
  }
}

/// Adds the interval that Student's t of the error gives.
void add_student(psychometric::Estimate& e) {
  if (!e.interval && e.deviation && e.freedom && *e.freedom > 0.0) {
    const double half = t_quantile(0.975, *e.freedom) * *e.deviation;
    e.interval = {e.value - half, e.value + half};
  }
}

AnsweredSeries series_of(const TrackEstimate& track) {
  AnsweredSeries series;
  for (const TrackStep& step : track.steps) {
    if (step.outcome == 0.0 || step.outcome == 1.0) {
      LevelTrial trial;
      trial.trial = step.trial;
      trial.level = trial.asked = step.applied;
      trial.outcome = step.outcome == 1.0 ? 1 : 0;
      series.trials.push_back(trial);
    }
  }
  return series;
}

/// Whether a function of what the procedure learnt from is fitted, whose parameters it may tell.
bool fitted(const TrackEstimate& track, const TrialsPlan& plan) {
  return plan.functions && plan.yes.empty() && (plan.level.empty() || plan.level == track.variable);
}

Defined<CredibleInterval> simulated_interval(const TrackEstimate& track, const TrialsPlan& plan,
                                             const ProcedureOf& procedure_of) {
  if (!fitted(track, plan)) {
    return Undefined{"no function of what the procedure learnt from is fitted"};
  }
  const auto blocks = blocks_of(series_of(track));
  const auto outside = [&](const TrialBlock& b) {
    return !std::isfinite(plan.function.axis.at(b.level));
  };
  if (blocks.size() < 2 || std::any_of(blocks.begin(), blocks.end(), outside)) {
    return Undefined{"there are fewer than two levels, or one is not on the axis"};
  }
  LikelihoodOptions options = likelihood_options(plan);
  options.presentable = range_on_axis(track.range, plan.function.axis);
  const auto draws = adaptive_posterior(blocks, options, 0.95, kPosteriorDraws).draws;
  const FinishedTrack again{track.estimates.front(), track.steps.size(), track.finished,
                            [&] { return procedure_of(track.track); }};
  return track_interval(again, plan.function, draws,
                        derived_seed(plan.seed, track.participant + " " + track.track));
}

void add_interval(TrackEstimate& track, const TrialsPlan& plan, const ProcedureOf& procedure_of) {
  if (track.adaptive && !track.estimates.empty() && track.estimates.front().interval &&
      !track.target && fitted(track, plan)) {
    for (psychometric::Estimate& e : track.estimates) {
      e.interval.reset();
    }
    track.no_interval =
        "the procedure's posterior assumes its own lapse and guess rates; the fitted function's "
        "does not";
    return;
  }
  for (psychometric::Estimate& e : track.estimates) {
    add_student(e);
  }
  if (!track.adaptive || track.estimates.empty() || track.estimates.front().interval ||
      !track.estimates.front().remark.empty()) {
    return;
  }
  if (track.ended_at_range()) {
    track.no_interval = "the track was at the end of its range";
    return;
  }
  const auto found = simulated_interval(track, plan, procedure_of);
  const double estimate = track.estimates.front().value;
  if (!found) {
    track.no_interval = found.because();
  } else if (estimate < found->low || estimate > found->high) {
    track.no_interval = "nearly all simulated tracks miss the level on the same side";
  } else {
    track.estimates.front().interval = {found->low, found->high};
  }
}

}  // namespace

void add_track_intervals(std::vector<TrackEstimate>& tracks, const TrialsPlan& plan,
                         const ProcedureOf& procedure_of, int threads) {
  in_groups(tracks.size(), 1, threads, [&] {
    return [&](std::size_t i, std::size_t) { add_interval(tracks[i], plan, procedure_of); };
  });
}

std::vector<TrackEstimate> track_estimates(const TrialsData& data,
                                           const ProcedureOf& procedure_of) {
  std::vector<TrackEstimate> tracks;
  std::vector<std::vector<psychometric::Level>> levels;
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    const StudyTrial& trial = data.trials[i];
    if (!trial.happened() || trial.levels.empty()) {  // also of trials that are left out: the
      continue;                                       // procedure went on from their answers
    }
    const GivenLevel& first = trial.levels.front();
    // Backwards: trials of a session lie together.
    const auto known = std::find_if(tracks.rbegin(), tracks.rend(), [&](const TrackEstimate& t) {
      return t.session == trial.session && t.track == first.track;
    });
    const bool fresh = known == tracks.rend();
    const std::size_t at =
        fresh ? tracks.size() : static_cast<std::size_t>(tracks.rend() - known) - 1;
    if (fresh) {
      tracks.push_back({trial.session,
                        data.session_of(trial).participant,
                        first.track,
                        first.variable,
                        {},
                        false,
                        {},
                        false,
                        {},
                        0,
                        {},
                        "",
                        ""});
      levels.emplace_back();
    }
    tracks[at].steps.push_back({i, first.applied, first.outcome, false});
    psychometric::Level level;
    for (const GivenLevel& each : trial.levels) {
      level.push_back(each.applied);
    }
    levels[at].push_back(std::move(level));
  }
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].steps.shrink_to_fit();
    const auto procedure = procedure_of ? procedure_of(tracks[i].track) : nullptr;
    if (procedure && procedure->has_reversals()) {
      mark_reversals(tracks[i].steps);
    }
    if (procedure) {
      tracks[i].adaptive = true;
      tracks[i].target = procedure->target();
      tracks[i].range = procedure->range();
      tracks[i].at_end = steps_at_end(tracks[i]);
      replay(tracks[i], levels[i], *procedure);
    } else {
      tracks[i].because = "its levels are listed";
    }
  }
  return tracks;
}

}  // namespace haptrial::analysis::trials
