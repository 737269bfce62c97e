#include "experiments/impossible.h"

#include <fmt/format.h>

#include "core/base/table.h"
#include "experiments/bone_definition.h"
#include "experiments/definition.h"

namespace haptrial::experiments {
namespace {

/// The sampling theorem: at half the rate and above there is nothing left of a sinusoid.
void reject_frequencies(Table& root, const Definition& d) {
  const double nyquist = 0.5 * d.rate;
  if (d.force_pattern.max_frequency >= nyquist) {
    root.table("force_pattern")
        .reject("max_frequency", fmt::format("{:g}", d.force_pattern.max_frequency),
                fmt::format("below half of experiment.rate, {:g} [Hz]", nyquist));
  }
  const double along = d.trajectory.max_spatial_frequency * d.trajectory.speed;
  if (d.trajectory.from.empty() && along >= nyquist) {
    root.table("trajectory")
        .reject("max_spatial_frequency",
                fmt::format("{:g}, which is {:g} Hz at {:g} m/s",
                            d.trajectory.max_spatial_frequency, along, d.trajectory.speed),
                fmt::format("below half of experiment.rate, {:g} [Hz]", nyquist));
  }
  const double shortest = 2.0 / d.rate;
  if (d.force_pattern.bumps_max > 0 && d.force_pattern.bump_width_min < shortest) {
    root.table("force_pattern")
        .reject("bump_width_min", fmt::format("{:g}", d.force_pattern.bump_width_min),
                fmt::format("at least two ticks, {:g} [s]", shortest));
  }
}

/// A speed that the envelope ends, either as such or as a jump within a tick.
void reject_speed(Table& root, const Setup& d, const char* table, const char* key, double speed) {
  if (speed > d.envelope.max_speed) {
    root.table(table).reject(
        key, fmt::format("{:g}", speed),
        fmt::format("at most envelope.max_speed, {:g} [m/s]", d.envelope.max_speed));
  } else if (speed / d.rate > d.envelope.max_jump) {
    root.table(table).reject(
        key, fmt::format("{:g}, which is {:g} m in a tick", speed, speed / d.rate),
        fmt::format("at most envelope.max_jump in a tick, {:g} [m]", d.envelope.max_jump));
  }
}

/// Neither force nor slope counts, and nothing but the alignment makes the score.
void reject_empty_score(Table& root, const analysis::ScoreParameters& p) {
  const auto& a = p.alignment;
  if (p.force_share == 0.0 && p.slope_share == 0.0 && a.force_weight == 0.0 &&
      a.slope_weight == 0.0) {
    root.table("analysis")
        .reject("force_weight", "0 as are slope_weight, force_share and slope_share",
                "one of these four above 0: else the score does not depend on the forces");
  }
}

}  // namespace

void reject_impossible(Table& root, const Definition& d) {
  reject_frequencies(root, d);
  reject_speed(root, d, "trajectory", "speed", d.trajectory.speed);
  reject_speed(root, d, "guidance", "approach_speed", d.guidance.approach_speed);
  reject_empty_score(root, d.scoring);
}

void reject_impossible(Table& root, const BoneDefinition& d) {
  if (root.has("drilling_hand")) {
    reject_speed(root, d, "drilling_hand", "speed", d.hand_plan.speed);
  }
}

}  // namespace haptrial::experiments
