#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::analysis {

/// How one run along the path went, training or test. Empty: not known.
struct RunQuality {
  std::optional<double> duration;               // [s]
  std::optional<double> target_peak;            // highest target force [N]
  std::optional<double> peak_force;             // largest applied force, either way [N]
  std::optional<double> saturation;             // share of ticks at the force limit
  std::optional<double> oscillation;            // share of the run in swings of the force that no
                                                // hand makes: 2 N or more, 10 Hz or faster
  std::optional<double> oscillation_frequency;  // of these swings, if there are any [Hz]
  std::optional<double> missing_ticks;          // share of the ticks that the rate promises
  std::optional<double> late_ticks;             // share that came half a period late or later
  std::optional<double> top_speed;              // between two ticks, from the positions [m/s]
  std::optional<double> reduced_damping;        // share of the run with less than the whole damping
  std::optional<double> dropped_frames;         // share of the screen's refreshes
};

/// How a scored trial was recorded. Empty: not known, or not defined.
struct TrialQuality {
  RunQuality test;
  RunQuality training;
  std::optional<double> lag;            // of the hand behind the moving target, in the test [s]
  std::optional<double> path_duration;  // of a run at the path's own speed [s]
  bool own_pace{false};                 // the participant set the pace
  int attempt{1};                       // above 1: the trial was aborted before
};

/// Limits from which on a trial is flagged. A flag is a remark: it excludes nothing by itself.
namespace flag {
/// Target forces up to the limit bring virtual participants of the shipped studies to it for up to
/// 14 % of a run, one in 3,456 for longer. Beyond that the recorded force is the device's and not
/// the participant's.
inline constexpr double kSaturation = 0.15;
/// The shipped studies have at most 0.7 %: the first swings after a target force at the limit.
inline constexpr double kOscillation = 0.05;
/// 0.15 s are three times what guidance needs in the shipped study, 0.05 s: the hand then followed
/// something else, and every force comes late by as much.
inline constexpr double kLag = 0.15;  // either way [s]
/// A path that sets the pace is over when it is over, but for a few ticks.
inline constexpr double kDuration = 0.02;  // of the path's own duration, either way
/// Limit of one's own pace: three times as fast, the bumps of the pattern last less than the 0.2 s
/// in which a force can be raised; three times as slow, it was a pause and no recall.
inline constexpr double kPace = 3.0;
/// Limit as for overruns of a whole session (too_many_overruns): beyond 1 % velocity, and with it
/// damping, is not what the definition says.
inline constexpr double kMissingTicks = 0.01;
inline constexpr double kLateTicks = 0.01;
/// The highest speed that the shipped envelopes allow: faster, the position jumped.
inline constexpr double kTopSpeed = 1.0;  // [m/s]
/// A tenth of the run guided less firmly than in the other trials.
inline constexpr double kReducedDamping = 0.1;
/// 0.3 s of a run of 15 s without a new picture, longer than it takes to react to one.
inline constexpr double kDroppedFrames = 0.02;
/// Limit of a recall: below a tenth of the target's peak nobody tried.
inline constexpr double kLeastForce = 0.1;
}  // namespace flag

struct TrialFlag {
  std::string name;  // one word, as in scores.csv: "saturated", "training_saturated", ...
  std::string
      reason;  // with the number: "97.0 % of the run at the force limit (flagged above 15 %)"
};

/// Faults of a trial, worst first; empty if all that is known is in order.
std::vector<TrialFlag> flags_of(const TrialQuality& quality);

/// The names of the flags, joined by ";".
std::string flag_names(const TrialQuality& quality);

/// A number of a trial's quality as a column of scores.csv.
struct QualityColumn {
  const char* name;
  const char* unit;  // "" of a share
  const char* description;
  std::optional<double>& (*field)(TrialQuality&);

  const std::optional<double>& of(const TrialQuality& quality) const {
    return field(const_cast<TrialQuality&>(quality));  // field() only finds the place
  }
};

/// Columns in the order of the table; a column `flags` with flag_names() follows them there.
std::span<const QualityColumn> quality_columns();

}  // namespace haptrial::analysis
