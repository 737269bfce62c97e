#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/reaching/force_compensation.h"
#include "analysis/reaching/reach_metrics.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis::trials {

/// Reach of one trial according to the definition.
struct ReachRoute {
  Eigen::Vector3d start{0.0, 0.0, 0.0};  // in W [m]
  Eigen::Vector3d target{0.0, 0.0, 0.0};
  double target_radius{0.01};                      // [m]
  Eigen::Matrix3d field{Eigen::Matrix3d::Zero()};  // B of the field that is learnt [N·s/m]
  bool active{false};                              // whether that field acts during the reach
  bool clamp{false};                               // whether a channel holds the hand on its way
};

/// How a reach went in its field.
enum class ReachKind : std::uint8_t {
  kPlain,  // what its block presents
  kClamp,  // in a channel
  kCatch,  // another probe
};

/// One reach, or why there is none to speak of.
struct StudyReach {
  std::size_t trial{0};  // in TrialsData::trials
  std::size_t order{0};  // from 0 among the participant's counted trials
  ReachKind kind{ReachKind::kPlain};
  std::string block;
  std::size_t place{0};  // in it, from 0; a trial that is missing or left out keeps its own free
  ReachRoute way;
  bool recorded{false};   // the trial has the stage, with all its samples
  bool arrived{false};    // the stage ended because its end was reached
  double saturated{0.0};  // share of the stage's ticks at the force limit
  ReachMetrics metrics;
  std::optional<double> error_at_150_ms;  // perpendicular [m]
  Defined<ForceCompensation> compensation{Undefined{"there was no channel"}};
  std::vector<Eigen::Vector3d> path;  // at 101 equal parts of its time; empty: no onset
  std::vector<double> speed;          // as speed_profile() [m/s]; empty: no onset
  double push{1.0};  // side to which the participant's field pushes: +1 left of the way, or -1
  double perturbation{0.0};  // 1 the participant's field, -1 the opposite one, 0 none

  /// A metric turned so that the field pushes towards +.
  std::optional<double> turned(const std::optional<double>& value) const;
};

/// The reaches of all trials that count, in the order of TrialsData::trials.
///
/// Positions are filtered without phase (fourth order, 20 Hz) and differentiated. The go signal is
/// the stage's first tick; 0.2 s before it belong to the recording, so that a hand which is already
/// on its way is seen.
/// @param files  of TrialsData::sessions, in their order
/// @param routes   of TrialsData::trials; nothing: the trial has no reach
/// @param clamp  name of a probe that counts as one in a channel, whatever acts
/// @throws InputError naming a file that is damaged
std::vector<StudyReach> study_reaches(const TrialsData& data,
                                      const std::vector<std::filesystem::path>& files,
                                      const std::vector<std::optional<ReachRoute>>& routes,
                                      const std::string& stage, const std::string& clamp,
                                      int threads);

}  // namespace haptrial::analysis::trials
