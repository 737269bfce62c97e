#include "analysis/force_training/study/session_recalls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "analysis/quality/session_quality.h"
#include "core/base/error.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/partner_rows.h"
#include "core/record/rows/session_tables.h"

namespace haptrial::analysis {
namespace {

using record::PassRow;
using record::PassStatus;
using record::Phase;
using record::Sample;
using record::SessionReader;
using record::StimulusRow;

std::map<std::int32_t, IdealPath> ideal_paths(const SessionReader& reader,
                                              std::vector<StimulusRow>& first_block) {
  std::map<std::int32_t, std::vector<StimulusRow>> blocks;
  for (const auto& row : reader.stimuli()) {
    blocks[row.block].push_back(row);
  }
  std::map<std::int32_t, IdealPath> paths;
  for (auto& [block, rows] : blocks) {
    if (first_block.empty() && block >= 0) {  // not of practice
      first_block = rows;
    }
    try {
      paths.emplace(block, std::move(rows));
    } catch (const std::invalid_argument&) {
      throw InputError(fmt::format(
          "{}: the times of the stimulus of block {} do not increase; the file is damaged",
          reader.path().string(), block));
    }
  }
  return paths;
}

std::vector<Eigen::Vector3d> positions_of(const std::vector<Sample>& run) {
  std::vector<Eigen::Vector3d> positions;
  for (const auto& sample : run) {
    positions.push_back(sample.position);
  }
  return positions;
}

/// The tracking of a run whose pace the participant set.
PassTracking tracking_at_own_pace(const std::vector<Sample>& run, const PathPlaces& path) {
  PassTracking result;
  result.lag = Undefined{"the participant set the pace"};
  result.samples = run.size();
  result.duration = 1e-9 * static_cast<double>(run.back().time_ns - run.front().time_ns);
  const HandPlaces places = path.of(positions_of(run));
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double in_plane = places.distance[i] * places.distance[i];
    result.squares_in_plane += in_plane;
    result.squares += in_plane + run[i].position.y() * run[i].position.y();
  }
  return result;
}

double in_plane(const Eigen::Vector3d& way) { return way.x() * way.x() + way.z() * way.z(); }

PassTracking tracking_of(const std::vector<Sample>& run, const IdealPath& ideal, double rate) {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> positions;
  for (const auto& sample : run) {
    times.push_back(1e-9 * static_cast<double>(sample.time_ns - run.front().time_ns));
    positions.push_back(sample.position);
  }
  return track_pass(times, positions, ideal, rate);
}

// Trial by trial: the row of the last completed test pass.
std::map<std::int32_t, std::size_t> counted_passes(const std::vector<PassRow>& passes) {
  std::map<std::int32_t, std::size_t> rows;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (!passes[i].practice && passes[i].phase == Phase::kTest &&
        passes[i].status == PassStatus::kCompleted) {
      rows[passes[i].trial] = i;
    }
  }
  return rows;
}

// Everything about one file while it is read.
class Extraction {
 public:
  Extraction(const SessionReader& reader, const ScoreParameters& parameters)
      : reader_(reader), parameters_(parameters), passes_(reader.passes()), quality_(reader) {
    record::check_phases(reader, std::array{Phase::kTraining, Phase::kTest});
    result_.summary.file = reader.path().filename().string();
    result_.summary.info = reader.info();
    paths_ = ideal_paths(reader, result_.stimulus);
    counted_ = counted_passes(passes_);
    for (const record::MarkedTrial& mark : record::marked_trials(reader)) {
      if (mark.left_out) {
        marked_.emplace(mark.trial, mark.reason);
      }
    }
    if (parameters.free_path && reader.has(record::table_of<record::TutoringRow>())) {
      expert_ = reader.rows<record::TutoringRow>();
    }
  }

  SessionRecalls run(int jobs) {
    for (std::size_t i = 0; i < passes_.size(); ++i) {
      take(i);
    }
    exclude_missing_tests();
    score(jobs);
    finish();
    return std::move(result_);
  }

 private:
  void take(std::size_t i) {
    const PassRow& pass = passes_[i];
    if (pass.practice) {
      return;
    }
    const bool test = pass.phase == Phase::kTest;
    result_.summary.test_passes += test ? 1 : 0;
    if (const auto mark = marked_.find(pass.trial); mark != marked_.end()) {
      const auto counted = counted_.find(pass.trial);
      if (test && (counted == counted_.end() || counted->second == i)) {
        exclude(pass.trial, "it was marked as bad: " + mark->second);
      }
      return;
    }
    if (pass.status != PassStatus::kCompleted) {
      if (test) {
        exclude(pass.trial, "the test pass was aborted");
      }
      return;
    }
    const auto samples = run_samples(reader_, pass);
    if (samples) {
      if (is_guided(pass)) {
        track(pass, *samples);
      }
      quality_.add(pass, *samples);
    }
    if (!test) {
      kept_[pass.trial] = kept_to(pass);
      return;
    }
    if (counted_.at(pass.trial) != i) {
      exclude(pass.trial, "the trial was repeated later");
      return;
    }
    if (!was_trained(pass.trial)) {
      exclude(pass.trial, "its training pass was aborted");
      return;
    }
    const auto curves = samples ? recall_curves(*samples, reader_.info().rate, places(pass.block))
                                : Defined<RecallCurves>(Undefined{samples.because()});
    if (!curves) {
      exclude(pass.trial, curves.because());
      return;
    }
    result_.scored.push_back({trial_of(pass), i});
    if (parameters_.free_path) {
      add_path(pass, *samples, result_.scored.back().score);
    } else {
      describe_path(pass, result_.scored.back().score.quality);
    }
    curves_.push_back(*curves);
  }

  // A definition may test without training; a training that was broken off is something else.
  bool was_trained(std::int32_t trial) const {
    bool tried = false;
    for (const auto& pass : passes_) {
      if (!pass.practice && pass.trial == trial && pass.phase == Phase::kTraining) {
        if (pass.status == PassStatus::kCompleted) {
          return true;
        }
        tried = true;
      }
    }
    return !tried;
  }

  std::span<const record::TutoringRow> expert_in(const PassRow& pass) const {
    const auto at = [this](std::uint64_t sequence) {
      return std::ranges::lower_bound(expert_, sequence, {}, &record::TutoringRow::sequence) -
             expert_.begin();
    };
    const auto first = at(pass.first_sample);
    return std::span(expert_).subspan(static_cast<std::size_t>(first),
                                      static_cast<std::size_t>(at(pass.last_sample + 1) - first));
  }

  /// Whether the device led the hand along the path.
  bool is_guided(const PassRow& pass) const {
    return !parameters_.free_path || (pass.phase != Phase::kTest && expert_in(pass).empty());
  }

  /// How far the led hand was from the expert's; nothing where it was not led.
  std::optional<double> kept_to(const PassRow& pass) const {
    constexpr double kLed = 0.99;  // of the authority: not while it is handed over
    double squares = 0.0;
    std::size_t count = 0;
    const auto rows = expert_in(pass);
    if (rows.empty()) {
      return std::nullopt;
    }
    const auto samples =
        record::rows_of_ticks(reader_, record::samples_table(), rows.front().sequence,
                              rows.back().sequence - rows.front().sequence + 1);
    auto sample = samples.begin();
    for (const record::TutoringRow& row : rows) {
      sample = std::find_if(sample, samples.end(),
                            [&](const Sample& s) { return s.sequence >= row.sequence; });
      if (sample == samples.end()) {
        break;
      }
      if (row.lead >= kLed && sample->sequence == row.sequence) {
        squares += in_plane(sample->position - row.position);
        ++count;
      }
    }
    return count > 0 ? std::optional(std::sqrt(squares / static_cast<double>(count)))
                     : std::nullopt;
  }

  void add_path(const PassRow& pass, const std::vector<Sample>& run, TrialScore& score) const {
    if (const auto path = paths_.find(pass.block); path != paths_.end()) {
      const PassTracking found = tracking_of(run, path->second, reader_.info().rate);
      score.path_error = std::sqrt(found.squares_in_plane / static_cast<double>(found.samples));
    }
    if (const auto kept = kept_.find(pass.trial); kept != kept_.end()) {
      score.kept = kept->second;
    }
  }

  void track(const PassRow& pass, const std::vector<Sample>& samples) {
    if (const PathPlaces* own_pace = places(pass.block)) {
      result_.tracking.push_back(tracking_at_own_pace(samples, *own_pace));
    } else if (const auto path = paths_.find(pass.block); path != paths_.end()) {
      result_.tracking.push_back(tracking_of(samples, path->second, reader_.info().rate));
    }
  }

  /// The scored pass is the one that was tracked last.
  void describe_path(const PassRow& pass, TrialQuality& quality) {
    if (const PathPlaces* own_pace = places(pass.block)) {
      quality.own_pace = true;
      quality.path_duration = own_pace->duration();
    } else if (const auto path = paths_.find(pass.block); path != paths_.end()) {
      quality.path_duration = path->second.duration();
      if (const auto& lag = result_.tracking.back().lag) {
        quality.lag = *lag;
      }
    }
  }

  /// Places on the block's path if the curves are over it; else null.
  const PathPlaces* places(std::int32_t block) {
    auto& known = places_[block];
    if (!known) {
      known = path_places(reader_, block, parameters_);
    }
    return known.get();
  }

  TrialScore trial_of(const PassRow& pass) const {
    TrialScore score;
    score.subject = reader_.info().subject;
    score.condition = pass.condition;
    score.trial = pass.trial;
    score.block = pass.block;
    score.repetition = pass.repetition;
    score.session = static_cast<std::int32_t>(reader_.info().session);
    score.levels = {pass.condition};
    score.quality = quality_.of(pass);
    return score;
  }

  void exclude(std::int32_t trial, std::string reason) {
    result_.exclusions.push_back({reader_.info().subject, trial, std::move(reason)});
  }

  void exclude_missing_tests() {
    std::set<std::int32_t> trained;
    std::set<std::int32_t> tested;
    for (const auto& pass : passes_) {
      if (pass.practice) {
        continue;
      }
      (pass.phase == Phase::kTest ? tested : trained).insert(pass.trial);
    }
    for (const auto trial : trained) {
      if (tested.count(trial) == 0) {
        exclude(trial, "there is no test pass");
      }
    }
  }

  void score(int jobs) {
    std::vector<RecallPair> pairs;
    for (const auto& curve : curves_) {
      pairs.push_back({&curve.target, &curve.applied});
    }
    try {
      const auto scores = score_recalls(pairs, parameters_, jobs);
      for (std::size_t k = 0; k < scores.size(); ++k) {
        fill(result_.scored[k].score, scores[k]);
        result_.scored[k].spectrum = recall_spectrum(curves_[k].target, curves_[k].applied);
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", reader_.path().string(), error.what()));
    }
  }

  void finish() {
    const auto by_trial = [](const auto& a, const auto& b) { return a.trial < b.trial; };
    std::stable_sort(result_.exclusions.begin(), result_.exclusions.end(), by_trial);
    std::stable_sort(result_.scored.begin(), result_.scored.end(),
                     [&](const auto& a, const auto& b) { return by_trial(a.score, b.score); });
    result_.summary.scored = result_.scored.size();
    result_.summary.tracking = summarize_tracking(result_.summary.info.subject, result_.tracking);
    result_.summary.timing = loop_timing(reader_);
  }

  const SessionReader& reader_;
  const ScoreParameters& parameters_;
  std::vector<PassRow> passes_;
  std::map<std::int32_t, std::unique_ptr<PathPlaces>> places_;  // by block
  std::map<std::int32_t, IdealPath> paths_;                     // by block
  std::map<std::int32_t, std::string> marked_;                  // why a trial is left out, by trial
  std::map<std::int32_t, std::size_t> counted_;                 // row of the test pass, by trial
  std::vector<record::TutoringRow> expert_;                     // ticks with an expert, in order
  std::map<std::int32_t, std::optional<double>> kept_;          // by trial
  SessionQuality quality_;
  std::vector<RecallCurves> curves_;  // one for each of result_.scored
  SessionRecalls result_;
};

}  // namespace

Defined<std::vector<Sample>> run_samples(const SessionReader& reader, const PassRow& pass) {
  if (pass.last_sample < pass.first_sample) {
    return Undefined{"its samples are not all in the file"};
  }
  const std::uint64_t count = pass.last_sample - pass.first_sample + 1;
  std::vector<Sample> samples =
      record::rows_of_ticks(reader, record::samples_table(), pass.first_sample, count);
  if (samples.size() != count || samples.front().sequence != pass.first_sample ||
      samples.back().sequence != pass.last_sample) {
    return Undefined{"its samples are not all in the file"};
  }
  std::erase_if(samples, [](const Sample& s) { return s.stage != record::Stage::kRun; });
  if (samples.size() < 2) {
    return Undefined{"the trajectory did not run"};
  }
  return samples;
}

Defined<RecallCurves> recall_curves(const std::vector<Sample>& run, double rate,
                                    const PathPlaces* places) {
  RecallCurves curves;
  curves.target.rate = rate;
  curves.applied.rate = rate;
  for (const auto& sample : run) {
    if (!std::isfinite(sample.target_force) || !std::isfinite(sample.applied_force)) {
      return Undefined{"a force is not a finite number"};
    }
    curves.target.force.push_back(sample.target_force);
    curves.applied.force.push_back(sample.applied_force);
  }
  if (places != nullptr) {
    const std::vector<double> along = places->of(positions_of(run)).along;
    curves.target = over_path(along, curves.target.force, places->duration());
    curves.applied = over_path(along, curves.applied.force, places->duration());
  }
  return curves;
}

std::unique_ptr<PathPlaces> path_places(const SessionReader& reader, std::int32_t block,
                                        const ScoreParameters& parameters) {
  if (!parameters.over_path) {
    return nullptr;
  }
  std::vector<StimulusRow> rows = reader.stimuli();
  std::erase_if(rows, [&](const StimulusRow& row) { return row.block != block; });
  if (rows.size() < 2) {
    throw InputError(
        fmt::format("{}: lacks the path of block {}, on which forces are to be compared",
                    reader.path().string(), block));
  }
  record::keep_even(rows);
  return std::make_unique<PathPlaces>(rows);
}

SessionRecalls session_recalls(const SessionReader& reader, const ScoreParameters& parameters,
                               int jobs) {
  return Extraction(reader, parameters).run(jobs);
}

}  // namespace haptrial::analysis
