#pragma once

#include <optional>

#include "core/base/definition/schema_forward.h"
#include "core/control/minimum_jerk.h"
#include "core/control/pd_controller.h"
#include "core/realtime/block_log.h"
#include "core/record/rows/partner_rows.h"
#include "core/stimulus/presentation.h"
#include "core/stimulus/stimulus.h"
#include "core/tutoring/tutoring_law.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/force_training/curve_guide.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// Guidance of the hand during the run.
enum class Guidance {
  kTrajectory,  // a target that moves along the path at its speed (§4.2.4)
  kCurve,       // the path itself, at the participant's own pace (§6.2)
};

/// How a hand is guided along a trajectory. Source: Morris 2006, §4.2.4.
struct GuidanceParameters {
  Guidance kind{Guidance::kTrajectory};
  control::PdGains trajectory{900.0, 100.0};  // in the xz plane
  control::PdGains plane{2000.0, 300.0};      // along y
  double force_limit{12.0};                   // the device saturates here > 0 [N]
  double approach_speed{0.10};                // peak, to the start and back >= 0.001 [m/s]
  double settle_distance{0.003};              // of the start, to be in before the run > 0 [m]
  double wait{0.5};                           // at the start, without a break >= 0 [s]
  double wait_timeout{10.0};                  // then the pass is aborted > 0 [s]
  double recovery{3.0};                       // without force after an abort >= 0 [s]
  double run_timeout{120.0};  // at one's own pace, or beside a playback; then it is aborted > 0 [s]
  control::CurveFollowing curve{};  // at one's own pace
  bool free_recall{false};          // nothing leads the hand in the test
  double pause_beyond{0.03};        // a playback waits for a hand so far off > 0 [m]
  TutoringOptions tutoring{};       // of a playback
};

/// Leader of the hand while the path runs.
enum class RunLead {
  kGuided,   // the guide, along the path
  kWatched,  // nothing: it is held at the start, and an expert is seen
  kPlayed,   // an expert's hand: a spring of low gain, and the expert's forces
  kFree,     // nothing
};

/// A kind of pass. During the run the plane constraint holds the hand along y; where it does not,
/// the device pushes the hand up with the target force. Outside the run the plane always holds.
struct PassKind {
  stimulus::Instruction instruction{stimulus::Instruction::kRest};
  RunLead lead{RunLead::kGuided};
  bool plane_holds{true};
  bool show_trajectory{true};
  bool show_target_bar{false};   // blue: the target force
  bool show_applied_bar{false};  // green: the applied force, to be matched
};

/// The test (T) after every training: the plane holds the hand, the participant applies the learnt
/// force. No picture of the force. Source: Morris 2006, §4.2.4.
inline constexpr PassKind kRecallTest{stimulus::Instruction::kRecall};

/// The test of path and force: the plane still carries the hand, but nothing leads it along the
/// path. When the path vanishes from the screen it is the participant's turn, for as long as the
/// path takes.
inline constexpr PassKind kFreeRecall{stimulus::Instruction::kReproduce, RunLead::kFree, true,
                                      false};

/// Ticks of an expert's run.
using ExpertLog = realtime::BlockLog<record::TutoringRow>;

/// The keys of [guidance].
const Schema<GuidanceParameters>& guidance_schema();

/// An instant of a pass, as far as it can be seen; a recorded sample holds the same.
struct PassMoment {
  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};  // p_W [m]
  record::Stage stage{record::Stage::kIdle};
  double along{0.0};          // the path, at its speed: time since the run began, or the place [s]
  double target_force{0.0};   // [N]
  double applied_force{0.0};  // [N]
  bool saturated{false};
  Eigen::Vector3d direction{Eigen::Vector3d::Zero()};  // on along the path, where self-paced
};

/// One pass along a trajectory:
///
///     approach the start -> wait there, settled -> run along it -> return to the start
///
/// The run is over when the path's time is, or, at the participant's own pace, when the hand has
/// come to its end. The force pattern is a function of how far along the path it is, either way.
/// The kinds of pass differ in what happens along y during the run and in what is shown. The guide
/// never jumps: every stage begins where the last one left its target.
class TrajectoryPass final : public Pass {
 public:
  /// @param stimulus  outlives the pass.  @param block  names the stimulus in the presentation.
  TrajectoryPass(const PassKind& kind, const stimulus::Stimulus& stimulus,
                 const GuidanceParameters& parameters, std::int32_t block);

  /// Sets the log for rows of the expert's run; it outlives the pass. Without it they are not kept.
  void record_expert(ExpertLog& log) noexcept { log_ = &log; }

  void begin(std::uint64_t sequence) noexcept override { sequence_ = sequence; }
  bool wants_attention() noexcept override {
    return log_ != nullptr && log_->size() > log_->capacity() / 2;
  }
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  PassState state() const noexcept override { return state_; }
  /// The participant's view at an instant: tick() shows it, and a replay shows it again. Before the
  /// pass and after a fault, when the stage is idle, that is nothing. Servo thread.
  stimulus::Presentation presentation(const PassMoment& moment) const noexcept;
  /// A guide along this pass's path, at its start; nothing where the path sets the pace.
  std::optional<CurveGuide> curve_guide() const;

 private:
  void enter(record::Stage stage) noexcept;
  PointState guide_target(const PointState& tool, double dt) noexcept;
  void settle(const PointState& tool, double dt) noexcept;
  void end_run_if_over() noexcept;
  PointState run_target(const PointState& tool) noexcept;
  double takes_hold() const noexcept;
  bool shows_expert() const noexcept {
    return kind_.lead == RunLead::kWatched || kind_.lead == RunLead::kPlayed;
  }
  bool waits_for_hand(const device::DeviceReading& reading) const noexcept;
  tutoring::Partner expert() const noexcept;
  double longest_run() const noexcept;
  PointState released(const PointState& tool) noexcept;
  void play(PassOutput& out, const device::DeviceReading& reading) noexcept;
  PassOutput output(const device::DeviceReading& reading, const PointState& target) noexcept;
  device::ForceIntent intent(const PointState& target, const device::DeviceReading& reading,
                             const Eigen::Vector3d& force, bool pushes) noexcept;

  PassKind kind_;
  const stimulus::Stimulus& stimulus_;
  GuidanceParameters parameters_;
  control::PdController trajectory_controller_;
  control::PdController plane_controller_;
  double share_{1.0};  // of the stiffness, on the tick before
  std::int32_t block_;
  record::Stage stage_{record::Stage::kIdle};
  PassState state_{PassState::kRunning};
  double time_{0.0};                                 // in the stage [s]
  double settled_{0.0};                              // at the start without a break [s]
  double along_{0.0};                                // the path during the run, at its speed [s]
  Eigen::Vector3d target_{Eigen::Vector3d::Zero()};  // where the guide was last [m]
  control::MinimumJerkMove move_;
  std::optional<CurveGuide> guide_;                      // where the participant sets the pace
  tutoring::Handover handover_;                          // from the guide to what leads the run
  tutoring::Handover pace_{tutoring::kTimeToRest, 1.0};  // share of the expert's speed
  double dt_{0.0};
  ExpertLog* log_{nullptr};
  std::uint64_t sequence_{0};
};

}  // namespace haptrial::protocols
