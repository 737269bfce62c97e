#include "protocols/force_training/trajectory_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/longer.h"

namespace haptrial::protocols {

using record::Stage;

namespace {

/// The path begins and ends at its full speed. What the damper makes of that speed comes and goes
/// over this time, so that the force does not jump; where the target is stays as the path says [s].
constexpr double kBlend = 0.08;

constexpr double kShortestMove = 0.2;  // a move of a millimetre would jerk at full speed [s]

}  // namespace

const Schema<GuidanceParameters>& guidance_schema() {
  using P = GuidanceParameters;
  const auto at_own_pace = [](const P& p) { return p.kind == Guidance::kCurve; };
  static const auto schema =
      Schema<P>()
          .choice("kind", &P::kind,
                  {{"trajectory", Guidance::kTrajectory}, {"curve", Guidance::kCurve}},
                  "What the hand follows: a point that moves in time, or a curve at the "
                  "participant's own pace")
          .table("trajectory", &P::trajectory, control::pd_gains_schema(),
                 "Gains of the spring to the trajectory")
          .required()
          .table("plane", &P::plane, control::pd_gains_schema(), "Gains of the spring to the plane")
          .required()
          .number("force_limit", &P::force_limit, {0.0, 100.0, true}, "N",
                  "Greatest force that guidance commands")
          .required()
          .number("approach_speed", &P::approach_speed, {0.001, 1.0}, "m/s",
                  "Peak speed at which the hand is led to the start")
          .required()
          .number("settle_distance", &P::settle_distance, {0.0, 0.1, true}, "m",
                  "Distance from the start within which the hand has arrived")
          .required()
          .number("wait", &P::wait, {0.0, 60.0}, "s", "Time that the hand must stay at the start")
          .required()
          .number("wait_timeout", &P::wait_timeout, {0.0, 600.0, true}, "s",
                  "Time after which a pass is aborted whose hand has not settled at the start")
          .required()
          .number("recovery", &P::recovery, {0.0, 600.0}, "s",
                  "Time without force after an aborted pass")
          .required()
          .choice("recall", &P::free_recall, {{"guided", false}, {"free", true}},
                  "Whether the hand is led in the test, or finds path and force by itself")
          .number("pause_beyond", &P::pause_beyond, {0.001, 1.0}, "m",
                  "Distance from the expert's hand beyond which a playback waits")
          .number("run_timeout", &P::run_timeout, {0.0, 3600.0, true}, "s",
                  "Longest duration of a run at the participant's own pace")
          .required()
          .only_if(at_own_pace)
          .table("curve", &P::curve, control::curve_following_schema(),
                 "How the place on the curve follows the hand")
          .required()
          .only_if(at_own_pace)
          .check([](Table& table, const P& p) {
            if (p.wait_timeout <= p.wait) {
              table.reject("wait_timeout", fmt::format("{}", p.wait_timeout),
                           fmt::format("a number above wait, {} [s]", p.wait));
            }
          });
  return schema;
}

TrajectoryPass::TrajectoryPass(const PassKind& kind, const stimulus::Stimulus& stimulus,
                               const GuidanceParameters& parameters, std::int32_t block)
    : kind_(kind),
      stimulus_(stimulus),
      parameters_(parameters),
      trajectory_controller_(parameters.trajectory),
      plane_controller_(parameters.plane),
      block_(block),
      guide_(curve_guide()),
      handover_(parameters.tutoring.ramp) {}

std::optional<CurveGuide> TrajectoryPass::curve_guide() const {
  if (parameters_.kind != Guidance::kCurve) {
    return std::nullopt;
  }
  return CurveGuide(stimulus_.path, parameters_.curve);
}

void TrajectoryPass::enter(Stage stage) noexcept {
  stage_ = stage;
  time_ = 0.0;
  settled_ = 0.0;
  const Eigen::Vector3d& start = stimulus_.path.points().front();
  if (stage == Stage::kApproach || stage == Stage::kReturn) {
    const double gentle = 15.0 / 8.0 * (start - target_).norm() / kShortestMove;
    move_ = control::MinimumJerkMove(target_, start,
                                     std::clamp(gentle, 1e-9, parameters_.approach_speed));
  } else if (stage == Stage::kRun) {
    along_ = 0.0;
    handover_ = tutoring::Handover(parameters_.tutoring.ramp);
    if (guide_) {
      guide_->start();
    }
  }
}

PointState TrajectoryPass::guide_target(const PointState& tool, double dt) noexcept {
  time_ += dt;
  switch (stage_) {
    case Stage::kIdle:
      target_ = tool.position;
      enter(Stage::kApproach);
      break;
    case Stage::kApproach:
      if (time_ >= move_.duration()) {
        enter(Stage::kWait);
      }
      break;
    case Stage::kWait:
      settle(tool, dt);
      break;
    case Stage::kRun:
      end_run_if_over();
      break;
    case Stage::kReturn:
      if (time_ >= move_.duration()) {
        state_ = PassState::kCompleted;
      }
      break;
  }
  switch (stage_) {
    case Stage::kRun:
      return run_target(tool);
    case Stage::kWait:
      return {stimulus_.path.points().front(), Eigen::Vector3d::Zero()};
    default:
      return move_.at(time_);
  }
}

void TrajectoryPass::settle(const PointState& tool, double dt) noexcept {
  const double distance = (tool.position - stimulus_.path.points().front()).norm();
  settled_ = distance <= parameters_.settle_distance ? settled_ + dt : 0.0;
  if (settled_ >= parameters_.wait && settled_ > 0.0) {
    enter(Stage::kRun);
  } else if (time_ >= parameters_.wait_timeout) {
    state_ = PassState::kAborted;
  }
}

void TrajectoryPass::end_run_if_over() noexcept {
  const double come = shows_expert() ? along_ : time_;
  const bool over = guide_ ? guide_->at_end() : come >= stimulus_.path.duration();
  if (over) {
    enter(Stage::kReturn);
  } else if ((guide_ || shows_expert()) && time_ >= longest_run()) {
    state_ = PassState::kAborted;
  }
}

PointState TrajectoryPass::run_target(const PointState& tool) noexcept {
  if (kind_.lead != RunLead::kGuided) {
    if (!shows_expert()) {
      along_ = time_;
    } else if (time_ > 0.0) {
      along_ += pace_.share() * parameters_.tutoring.speed * dt_;
    }
    return released(tool);
  }
  if (!guide_) {
    along_ = time_;
    PointState target = stimulus_.path.at(time_);
    const double left = stimulus_.path.duration() - time_;
    target.velocity *= std::clamp(std::min(time_, left) / kBlend, 0.0, 1.0);
    return target;
  }
  const PointState target = guide_->follow(tool);
  along_ = guide_->along();
  return target;
}

PassOutput TrajectoryPass::tick(const Readings& readings, double dt) noexcept {
  const PointState& tool = readings[0].tool;
  dt_ = dt;
  pace_.ask(waits_for_hand(readings[0]) ? 0.0 : 1.0);
  pace_.step(dt);
  const PointState target = guide_target(tool, dt);
  PassOutput out = output(readings[0], target);
  target_ = target.position;
  if (stage_ == Stage::kRun && shows_expert()) {
    play(out, readings[0]);
  }
  if (stage_ == Stage::kRun && (kind_.lead == RunLead::kPlayed || kind_.lead == RunLead::kFree)) {
    target_ = tool.position;  // the way back starts where the hand is
  }
  ++sequence_;
  if (stage_ == Stage::kRun && !kind_.plane_holds) {
    target_.y() = tool.position.y();  // the return starts where the hand is
  }
  return out;
}

/// State of the expert, who presses as hard as the pattern asks, so that the world pushes back.
tutoring::Partner TrajectoryPass::expert() const noexcept {
  tutoring::Partner expert;
  expert.tool = stimulus_.path.at(along_);
  expert.tool.velocity *= pace_.share() * parameters_.tutoring.speed;
  expert.force.y() = stimulus_.force.at(along_);
  return expert;
}

/// A playback waits while it is asked to, and for a hand that was left behind.
bool TrajectoryPass::waits_for_hand(const device::DeviceReading& reading) const noexcept {
  if (stage_ != Stage::kRun || kind_.lead != RunLead::kPlayed) {
    return false;
  }
  const Eigen::Vector3d away = stimulus_.path.at(along_).position - reading.tool.position;
  return asks_to_wait(parameters_.tutoring, reading) ||
         std::hypot(away.x(), away.z()) > parameters_.pause_beyond;
}

double TrajectoryPass::longest_run() const noexcept {
  const double played = stimulus_.path.duration() / parameters_.tutoring.speed;
  return (guide_ ? 0.0 : played) + parameters_.run_timeout;
}

/// Target of a guide that fades out: it goes over to where the tool is.
PointState TrajectoryPass::released(const PointState& tool) noexcept {
  handover_.ask(kind_.lead == RunLead::kWatched ? 0.0 : 1.0);
  const double share = handover_.step(dt_);
  const Eigen::Vector3d& start = stimulus_.path.points().front();
  PointState target{(1.0 - share) * start + share * tool.position, share * tool.velocity};
  target.position.y() = start.y();
  target.velocity.y() = 0.0;
  return target;
}

/// Plays the force of an expert's hand, in place of the push of the target force; a row of it.
void TrajectoryPass::play(PassOutput& out, const device::DeviceReading& reading) noexcept {
  const PointState& tool = reading.tool;
  const tutoring::Partner model = expert();
  const double share = handover_.share();
  Eigen::Vector3d played = Eigen::Vector3d::Zero();
  if (kind_.lead == RunLead::kPlayed) {
    const tutoring::TutoringGains& gains = parameters_.tutoring.gains;
    const Eigen::Vector3d coupling =
        share * tutoring::coupling_force(gains, model.tool, tool, reading.shares);
    played = share * gains.force_share * model.force + coupling;
    Eigen::Vector3d own = out.force;
    own.y() *= 1.0 - share;
    out.force = control::saturate(own + played, parameters_.force_limit);
    out.saturated = longer(own + played, parameters_.force_limit);
    const double stretch = (model.tool.position - tool.position).squaredNorm();
    out.intent.push = out.force - Eigen::Vector3d(own.x(), 0.0, own.z()) - coupling;
    out.intent.drive = model.tool.velocity;
    out.intent.stored += 0.5 * share * reading.shares.stiffness * gains.stiffness * stretch;
    out.shown = presentation(
        {tool.position, stage_, along_, out.target_force, out.force.y(), out.saturated});
  }
  if (log_ != nullptr) {
    const double lead = kind_.lead == RunLead::kPlayed ? share : 0.0;
    log_->push({sequence_, along_, lead, model.tool.position, model.force, played});
  }
}

/// Share of the plane's damper: after a run in which the hand was free along y it may be moving
/// there, so that the damper comes by degrees.
double TrajectoryPass::takes_hold() const noexcept {
  return stage_ == Stage::kReturn && !kind_.plane_holds ? std::clamp(time_ / kBlend, 0.0, 1.0)
                                                        : 1.0;
}

PassOutput TrajectoryPass::output(const device::DeviceReading& reading,
                                  const PointState& target) noexcept {
  const PointState& tool = reading.tool;
  const bool runs = stage_ == Stage::kRun;
  const bool pushes = runs && !kind_.plane_holds;
  PassOutput out;
  out.stage = stage_;
  out.target_force = runs ? stimulus_.force.at(along_) : 0.0;
  Eigen::Vector3d wanted = trajectory_controller_.force(target, tool, reading.shares);
  const control::GainShares held{reading.shares.stiffness, takes_hold() * reading.shares.damping};
  wanted.y() = pushes ? out.target_force : plane_controller_.force(target, tool, held).y();
  out.most = parameters_.force_limit;
  out.force = control::saturate(wanted, out.most);
  out.intent = intent(target, reading, out.force, pushes);
  out.saturated = longer(wanted, out.most);

  PassMoment moment{tool.position, stage_, along_, out.target_force, out.force.y(), out.saturated};
  if (runs && guide_) {
    moment.direction = guide_->direction();
  }
  out.shown = presentation(moment);
  return out;
}

/// The springs follow their target; what pushes the hand up is meant to.
device::ForceIntent TrajectoryPass::intent(const PointState& target,
                                           const device::DeviceReading& reading,
                                           const Eigen::Vector3d& force, bool pushes) noexcept {
  const Eigen::Vector3d stretch = target.position - reading.tool.position;
  const double limit = parameters_.force_limit;
  device::ForceIntent intent;
  intent.drive = target.velocity;
  const auto stored = [&](double share) {
    const double beside = std::hypot(stretch.x(), stretch.z());
    return trajectory_controller_.stored(beside, limit, share) +
           (pushes ? 0.0 : plane_controller_.stored(stretch.y(), limit, share));
  };
  const double share = reading.shares.stiffness;
  intent.stored = stored(share);
  intent.added = share != share_ ? intent.stored - stored(share_) : 0.0;
  share_ = share;
  if (pushes) {
    intent.push.y() = force.y();
  }
  return intent;
}

stimulus::Presentation TrajectoryPass::presentation(const PassMoment& moment) const noexcept {
  stimulus::Presentation seen;
  seen.tool = moment.tool;
  if (moment.stage == Stage::kIdle) {
    return seen;
  }
  seen.show_trajectory = true;
  seen.show_saturation = moment.saturated;
  seen.pass_duration = stimulus_.path.duration();
  seen.block = block_;
  if (moment.stage == Stage::kRun) {
    seen.progress = std::clamp(moment.along / seen.pass_duration, 0.0, 1.0);
    seen.self_paced = guide_.has_value();
    seen.direction = moment.direction;
    seen.instruction = kind_.instruction;
    seen.show_trajectory = kind_.show_trajectory;
    seen.show_target_bar = kind_.show_target_bar;
    seen.show_applied_bar = kind_.show_applied_bar;
    if (kind_.lead == RunLead::kWatched) {  // the marker is the expert's tool
      seen.tool = stimulus_.path.at(seen.progress * stimulus_.path.duration()).position;
    }
    // Values that are not shown are left out: nobody who is presented with the view can know more
    // than a person.
    seen.target_force = seen.show_target_bar ? moment.target_force : 0.0;
    seen.applied_force = seen.show_applied_bar ? moment.applied_force : 0.0;
  } else if (moment.stage == Stage::kReturn) {
    seen.progress = 1.0;
  }
  return seen;
}

}  // namespace haptrial::protocols
