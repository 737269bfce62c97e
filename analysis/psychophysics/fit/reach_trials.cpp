#include "analysis/psychophysics/fit/reach_trials.h"

#include <algorithm>
#include <array>
#include <map>

#include "analysis/reaching/reaching_figures.h"
#include "analysis/reaching/zero_phase_filter.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kLead = 0.2;         // of the recording before the go signal [s]
constexpr double kErrorAfter = 0.15;  // after onset [s]
constexpr double kNoPush = 1e-6;      // share of the field below which it pushes to no side

/// The samples of a reach, with those just before it; none if some are missing.
struct ReachSamples {
  std::vector<double> time;  // from the go signal [s]
  std::vector<Eigen::Vector3d> position, force;
  double saturated{0.0};
};

ReachSamples samples_of(const record::SessionReader& reader, const StudyTrial& trial,
                        const StageTime& stage) {
  const double rate = reader.info().rate;
  const std::uint64_t go = trial.first_sample + stage.first;
  const std::uint64_t first =
      go - std::min<std::uint64_t>(static_cast<std::uint64_t>(kLead * rate), stage.first);
  const std::uint64_t ticks = go + stage.ticks - first;
  ReachSamples samples;
  const std::vector<record::Sample> rows =
      record::rows_of_ticks(reader, record::samples_table(), first, ticks);
  if (stage.ticks == 0 || rows.size() != ticks) {
    return samples;
  }
  for (const record::Sample& row : rows) {
    samples.time.push_back((static_cast<double>(row.sequence) - static_cast<double>(go)) / rate);
    samples.position.push_back(row.position);
    samples.force.push_back(row.force);
    samples.saturated += row.saturated && row.sequence >= go ? 1.0 : 0.0;
  }
  samples.saturated /= static_cast<double>(stage.ticks);
  return samples;
}

void measure(const ReachSamples& samples, double rate, StudyReach& reach) {
  const auto motion = smooth_motion(samples.position, rate);
  if (!motion) {
    return;
  }
  const Reach recorded{samples.time,
                       motion->position,
                       motion->velocity,
                       samples.force,
                       reach.way.start,
                       reach.way.target,
                       0.0};
  MetricOptions options;
  options.target_radius = reach.way.target_radius;
  reach.recorded = true;
  reach.saturated = samples.saturated;
  reach.metrics = reach_metrics(recorded, options);
  reach.error_at_150_ms = perpendicular_error_at(recorded, reach.metrics, kErrorAfter);
  if (!reach.metrics.onset) {
    reach.compensation = Undefined{"the hand did not move"};
    return;
  }
  const double end = reach.metrics.end.value_or(samples.time.back());
  const std::array one{TimedReach{recorded, *reach.metrics.onset, end}};
  reach.path = mean_path(one);
  reach.speed = speed_profile(one.front());
  if (reach.kind == ReachKind::kClamp) {
    reach.compensation = force_compensation(recorded, reach.way.field, *reach.metrics.onset, end);
  }
}

void measure_session(const std::filesystem::path& file, const TrialsData& data,
                     const std::string& stage, std::vector<StudyReach*>& reaches) {
  const record::SessionReader reader(file);
  for (StudyReach* reach : reaches) {
    const StudyTrial& trial = data.trials[reach->trial];
    if (const StageTime* time = last_stage(trial, stage)) {
      reach->arrived = time->reached;
      measure(samples_of(reader, trial, *time), reader.info().rate, *reach);
    }
  }
}

/// How much of `field` is `reference`: 1 for the same, -1 for the opposite.
double share_of(const Eigen::Matrix3d& field, const Eigen::Matrix3d& reference) {
  const double square = reference.squaredNorm();
  return square > 0.0 ? field.cwiseProduct(reference).sum() / square : 0.0;
}

/// Whether reaches of one block have fields that push this way and that.
bool alternates(const std::vector<StudyReach*>& reaches, const Eigen::Matrix3d& field) {
  std::map<std::string, bool> pushes;  // as `field` does, by block
  return std::ranges::any_of(reaches, [&](const StudyReach* each) {
    const double share = each->way.active ? share_of(each->way.field, field) : 0.0;
    return share != 0.0 &&
           pushes.try_emplace(each->block, share > 0.0).first->second != (share > 0.0);
  });
}

/// The one of a field and its opposite whose largest entry is positive.
Eigen::Matrix3d without_sign(const Eigen::Matrix3d& field) {
  Eigen::Index row = 0, column = 0;
  field.cwiseAbs().maxCoeff(&row, &column);
  return field(row, column) < 0.0 ? Eigen::Matrix3d(-field) : field;
}

/// The field that a participant learns is the first that acts, as one of zeros does not; if none
/// does, the first stated. A field that turns over from trial to trial is learnt by nobody: then
/// the sign is the same for all, whichever came first.
void turn_to_field(std::vector<StudyReach*>& reaches) {
  const auto active = std::find_if(reaches.begin(), reaches.end(), [](const StudyReach* each) {
    return each->way.active && !each->way.field.isZero(0.0);
  });
  const Eigen::Matrix3d first = (active == reaches.end() ? reaches.front() : *active)->way.field;
  const Eigen::Matrix3d field = alternates(reaches, first) ? without_sign(first) : first;
  for (StudyReach* reach : reaches) {
    const WayFrame frame(reach->way.start, reach->way.target);
    const double push = frame.lateral(field * frame.along());
    reach->push = push < -kNoPush * field.norm() ? -1.0 : 1.0;
    reach->perturbation = reach->way.active ? share_of(reach->way.field, field) : 0.0;
  }
}

using PlaceOfTrial = std::map<std::pair<std::size_t, int>, std::size_t>;  // by session and number

/// The planned places of trials in their blocks, so that the cycles of all others stay as they were
/// planned where a trial was left out, skipped or given up.
PlaceOfTrial planned_places(const TrialsData& data,
                            const std::vector<std::optional<ReachRoute>>& routes) {
  std::map<std::size_t, std::map<int, std::optional<std::string>>>
      blocks;  // of trials with a reach
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    const StudyTrial& trial = data.trials[i];
    if (!trial.practice) {
      const bool without_reach = trial.counts() && !routes[i];
      auto& block = blocks[trial.session][trial.trial];
      block = without_reach ? block : factor_level(data, trial, "block");
    }
  }
  PlaceOfTrial places;
  for (const auto& [session, numbers] : blocks) {
    std::map<std::string, std::size_t> next;
    std::optional<std::string> block;
    for (int number = numbers.begin()->first; number <= numbers.rbegin()->first; ++number) {
      const auto found = numbers.find(number);
      block = found != numbers.end() ? found->second : block;
      if (block) {
        places[{session, number}] = next[*block]++;
      }
    }
  }
  return places;
}

}  // namespace

std::optional<double> StudyReach::turned(const std::optional<double>& value) const {
  return value ? std::optional(push * *value) : std::nullopt;
}

std::vector<StudyReach> study_reaches(const TrialsData& data,
                                      const std::vector<std::filesystem::path>& files,
                                      const std::vector<std::optional<ReachRoute>>& routes,
                                      const std::string& stage, const std::string& clamp,
                                      int threads) {
  std::vector<StudyReach> reaches;
  std::map<std::string, std::size_t> counted;
  const PlaceOfTrial places = planned_places(data, routes);
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    const StudyTrial& trial = data.trials[i];
    if (!trial.counts() || !routes.at(i)) {
      continue;
    }
    StudyReach reach;
    reach.trial = i;
    reach.order = counted[data.session_of(trial).participant]++;
    reach.way = *routes[i];
    const bool held = reach.way.clamp || (!trial.probe.empty() && trial.probe == clamp);
    reach.kind = held                  ? ReachKind::kClamp
                 : trial.probe.empty() ? ReachKind::kPlain
                                       : ReachKind::kCatch;
    reach.block = factor_level(data, trial, "block");
    reach.place = places.at({trial.session, trial.trial});
    reaches.push_back(std::move(reach));
  }
  std::vector<std::vector<StudyReach*>> by_session(data.sessions.size());
  std::map<std::string, std::vector<StudyReach*>> by_participant;
  for (StudyReach& reach : reaches) {
    const StudyTrial& trial = data.trials[reach.trial];
    by_session[trial.session].push_back(&reach);
    by_participant[data.session_of(trial).participant].push_back(&reach);
  }
  for (auto& [participant, own] : by_participant) {
    turn_to_field(own);
  }
  parallel_for(files.size(), threads_or_all(threads), [&](std::size_t session) {
    if (!by_session.at(session).empty()) {
      measure_session(files[session], data, stage, by_session[session]);
    }
  });
  return reaches;
}

}  // namespace haptrial::analysis::trials
