#include "analysis/quality/trial_quality.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace haptrial::analysis {
namespace {

/// Collects the flags of one trial.
class Flags {
 public:
  void add(const char* name, std::string reason) {
    flags_.push_back({prefix_ + name, words_ + std::move(reason)});
  }

  void share(const char* name, const std::optional<double>& value, double most, const char* what) {
    if (value && *value > most) {
      add(name,
          fmt::format("{:.1f} % of {} (flagged above {:g} %)", 100.0 * *value, what, 100.0 * most));
    }
  }

  void run(const RunQuality& run, const char* prefix, const char* words) {
    prefix_ = prefix;
    words_ = words;
    if (run.oscillation > flag::kOscillation) {
      add("oscillating",
          fmt::format("the force swung at {:.0f} Hz for {:.1f} % of the run (flagged above {:g} %)",
                      run.oscillation_frequency.value_or(0.0), 100.0 * *run.oscillation,
                      100.0 * flag::kOscillation));
    }
    share("saturated", run.saturation, flag::kSaturation, "the run at the force limit");
    share("missing_ticks", run.missing_ticks, flag::kMissingTicks, "the run's ticks missing");
    share("late_ticks", run.late_ticks, flag::kLateTicks, "the run's ticks late");
    if (run.top_speed > flag::kTopSpeed) {
      add("jump", fmt::format("the position jumped: {:.2f} m/s between two ticks (flagged above "
                              "{:g} m/s)",
                              *run.top_speed, flag::kTopSpeed));
    }
    share("reduced_damping", run.reduced_damping, flag::kReducedDamping,
          "the run with reduced damping");
    share("dropped_frames", run.dropped_frames, flag::kDroppedFrames,
          "the screen's refreshes without a new picture");
    prefix_.clear();
    words_.clear();
  }

  std::vector<TrialFlag> take() { return std::move(flags_); }

 private:
  std::string prefix_;
  std::string words_;
  std::vector<TrialFlag> flags_;
};

void judge_duration(Flags& flags, const TrialQuality& q) {
  if (!q.test.duration || !q.path_duration || !(*q.path_duration > 0.0)) {
    return;
  }
  const double ratio = *q.test.duration / *q.path_duration;
  const bool far_off = q.own_pace ? ratio > flag::kPace || ratio < 1.0 / flag::kPace
                                  : std::abs(ratio - 1.0) > flag::kDuration;
  if (far_off) {
    flags.add(
        "duration",
        fmt::format("the run took {:.2f} s, the path at its own speed {:.2f} s "
                    "({})",
                    *q.test.duration, *q.path_duration,
                    q.own_pace ? fmt::format("flagged beyond a factor of {:g}", flag::kPace)
                               : fmt::format("flagged beyond {:g} %", 100.0 * flag::kDuration)));
  }
}

}  // namespace

std::vector<TrialFlag> flags_of(const TrialQuality& q) {
  Flags flags;
  flags.run(q.test, "", "");
  judge_duration(flags, q);
  if (q.lag && std::abs(*q.lag) > flag::kLag) {
    flags.add("lag", fmt::format("the hand was {:.0f} ms {} the target (flagged above {:.0f} ms)",
                                 1e3 * std::abs(*q.lag), *q.lag > 0.0 ? "behind" : "ahead of",
                                 1e3 * flag::kLag));
  }
  if (q.test.peak_force && q.test.target_peak &&
      *q.test.peak_force < flag::kLeastForce * *q.test.target_peak) {
    flags.add("no_force",
              fmt::format("the applied force reached {:.2f} N, the target {:.2f} N (flagged below "
                          "{:g} % of it)",
                          *q.test.peak_force, *q.test.target_peak, 100.0 * flag::kLeastForce));
  }
  flags.run(q.training, "training_", "training: ");
  if (q.attempt > 1) {
    flags.add("repeated",
              fmt::format("attempt {}: the trial was aborted before, so the participant "
                          "met its stimulus more often",
                          q.attempt));
  }
  return flags.take();
}

std::string flag_names(const TrialQuality& quality) {
  std::string names;
  for (const TrialFlag& flag : flags_of(quality)) {
    names += (names.empty() ? "" : ";") + flag.name;
  }
  return names;
}

std::span<const QualityColumn> quality_columns() {
  using Q = TrialQuality;
  static constexpr QualityColumn kColumns[] = {
      {"duration", "s", "of the test's run", [](Q & q) -> auto& {return q.test.duration;
}
}  // namespace haptrial::analysis
, {"lag", "s", "of the hand behind the moving target; empty at the participant's own pace",
   [](Q& q) -> auto& {return q.lag;
}
}
, {"peak_force", "N", "largest applied force of the test",
   [](Q& q) -> auto& {return q.test.peak_force;
}
}
, {"saturation", "", "share of the test's ticks at the force limit",
   [](Q& q) -> auto& {return q.test.saturation;
}
}
, {"training_saturation", "", "share of the training's ticks at the force limit",
   [](Q& q) -> auto& {return q.training.saturation;
}
}
, {"oscillation", "",
   "share of the test in which the force swung by 2 N or more at 10 Hz or faster",
   [](Q& q) -> auto& {return q.test.oscillation;
}
}
, {"oscillation_frequency", "Hz", "of these swings; empty if there are none",
   [](Q& q) -> auto& {return q.test.oscillation_frequency;
}
}
, {"training_oscillation", "", "share of the training in which the force swung so",
   [](Q& q) -> auto& {return q.training.oscillation;
}
}
, {"reduced_damping", "", "share of the test with less damping than the definition asks for",
   [](Q& q) -> auto& {return q.test.reduced_damping;
}
}
, {"missing_ticks", "", "share of the test's ticks that were not made",
   [](Q& q) -> auto& {return q.test.missing_ticks;
}
}
, {"late_ticks", "", "share of the test's ticks that came half a period late or later",
   [](Q& q) -> auto& {return q.test.late_ticks;
}
}
, {"top_speed", "m/s", "between two ticks of the test, from the positions",
   [](Q& q) -> auto& {return q.test.top_speed;
}
}
, {"dropped_frames", "", "share of the screen's refreshes in the test without a new picture",
   [](Q& q) -> auto& {return q.test.dropped_frames;
}
}
, {
  "training_dropped_frames", "", "the same in the training", [](Q & q) -> auto& {
    return q.training.dropped_frames;
  }
}
}
;
return kColumns;
}

}  // namespace haptrial::analysis
