#include "core/subject/drilling/drilling_hand.h"

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/definition/table_vector.h"
#include "core/subject/drilling/drilling_arm.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {
namespace {

constexpr double kStrongestAcross = 5.0;  // of the arm across the press [N]
constexpr double kHighest = 0.02;         // over where bone was met first [m]
constexpr double kBetweenStrokes = 0.06;  // speed between strokes [m/s]
constexpr double kDescent = 0.03;         // towards the bone [m/s]
constexpr double kNear = 0.002;           // is there [m]
constexpr double kWaitForBone = 4.0;      // without bone below, then on to the next line [s]
constexpr double kLookTime = 0.4;         // [s]

SubjectParameters person_of(const DrillingHandParameters& p) {
  SubjectParameters person;
  person.force_noise = p.force_noise;
  person.force_noise_time = p.force_noise_time;
  person.tremor = p.tremor;
  person.tremor_frequency = p.tremor_frequency;
  return person;
}

}  // namespace

const Schema<DrillingHandParameters>& drilling_hand_schema() {
  using P = DrillingHandParameters;
  static const auto schema =
      Schema<P>()
          .vector("start", &P::start, {-1.0, 1.0}, "m",
                  "Place at which the virtual hand begins, above the middle of the region to drill")
          .required()
          .direction("inward", &P::inward,
                     "Direction into the bone in which the virtual hand presses")
          .required()
          .direction("along", &P::along, "Direction of the virtual hand's strokes")
          .required()
          .check([](Table& table, P& p) {
            if (!(p.along.cross(p.inward).norm() > 0.1)) {
              table.reject("along",
                           "is nearly the direction of inward; write a direction across it");
            }
            p.along = (p.along - p.along.dot(p.inward) * p.inward).normalized();
          })
          .number("width", &P::width, {1e-4, 0.1}, "m",
                  "Width of the region to drill, along strokes")
          .number("height", &P::height, {0.0, 0.1}, "m",
                  "Height of the region to drill, across strokes")
          .number("depth", &P::depth, {0.0, 0.1}, "m",
                  "Depth of the region to drill, below the place where bone was first touched")
          .number("line", &P::line, {1e-4, 0.1}, "m", "Distance between neighbouring strokes")
          .number("press", &P::press, {0.0, 20.0}, "N",
                  "Force with which the virtual hand presses on the bone")
          .number("speed", &P::speed, {1e-3, 0.2}, "m/s",
                  "Speed of the virtual hand along a stroke")
          .number("hover", &P::hover, {0.0, 0.05}, "m", "Height above the bone between strokes")
          .number("force_noise", &P::force_noise, {0.0, 1.0}, "",
                  "Noise of the virtual hand's force, as a share of the pressing force")
          .number("force_noise_time", &P::force_noise_time, {0.001, 10.0}, "s",
                  "Correlation time of the noise of the virtual hand's force")
          .number("tremor", &P::tremor, {0.0, 1.0}, "N",
                  "Root mean square of the virtual hand's tremor")
          .number("tremor_frequency", &P::tremor_frequency, {1.0, 50.0}, "Hz",
                  "Frequency of the virtual hand's tremor")
          .number("suction_time", &P::suction_time, {0.0, 600.0}, "s", "Duration of a suction")
          .integer("power_button", &P::power_button, 0, 30,
                   "Button of the device with which the virtual hand turns the burr")
          .integer("next_button", &P::next_button, -1, 30,
                   "Button of the device with which the virtual hand takes the next tool; -1: no "
                   "suction")
          .integer("previous_button", &P::previous_button, -1, 30,
                   "Button of the device with which the virtual hand takes the tool before")
          .integer("look_button", &P::look_button, -1, 30,
                   "Button of the device with which the virtual hand turns the camera while held; "
                   "-1: never")
          .integer("suction_tool", &P::suction_tool, 1, 31, "Place of the suction among the tools")
          .integer("strokes_to_suction", &P::strokes_to_suction, 1, 1'000'000,
                   "Number of strokes after which suction follows");
  return schema;
}

DrillingHand::DrillingHand(const DrillingHandParameters& parameters, HandModel& hand,
                           device::VirtualDevice& device, double scale, std::uint64_t seed,
                           double step)
    : parameters_(parameters),
      hand_(hand),
      device_(device),
      scale_(scale),
      noise_(person_of(parameters), step, RandomStream(seed, "drilling hand")),
      across_(parameters.inward.cross(parameters.along)),
      lines_(1 + static_cast<int>(parameters.height / parameters.line)) {}

void DrillingHand::begin(Activity doing) noexcept {
  doing_ = doing;
  time_ = 0.0;
}

Eigen::Vector3d DrillingHand::line_start() const noexcept {
  const DrillingHandParameters& p = parameters_;
  const double sideways = (line_ - 0.5 * (lines_ - 1)) * p.line;
  const double end = back_ ? 0.5 * p.width : -0.5 * p.width;
  return p.start + end * p.along + sideways * across_;
}

void DrillingHand::next_line() noexcept {
  ++strokes_;
  back_ = !back_;
  line_ = (line_ + 1) % lines_;
  const bool sucks = parameters_.next_button >= 0 && parameters_.previous_button >= 0;
  if (sucks && strokes_ % parameters_.strokes_to_suction == 0) {
    wanted_tool_ = parameters_.suction_tool;
    begin(Activity::kChange);
  } else if (line_ == 0 && parameters_.look_button >= 0) {
    begin(Activity::kLook);
  } else {
    begin(Activity::kReach);
  }
}

void DrillingHand::observe(const stimulus::Shown& shown, const stimulus::Forces&,
                           double dt) noexcept {
  const auto* seen = shown.as<bone::DrillingView>();
  if (seen == nullptr || !seen->shown) {
    hand_.command({0.0, false, noise_.tremor()});
    device_.hold(0, 0.0, Eigen::Quaterniond::Identity());
    begin(Activity::kReach);
    tip_known_ = false;
    return;
  }
  const bone::DrillingView& view = *seen;
  const Eigen::Vector3d tip = scale_ * view.tip;
  decide(view, tip);
  HandCommand command;
  command.force = push(view, tip, dt) + noise_.tremor();
  hand_.command(command);
  device_.hold(fingers(view), 0.0, Eigen::Quaterniond::Identity());
  last_tip_ = tip;
  tip_known_ = true;
  time_ += dt;
}

void DrillingHand::decide(const bone::DrillingView& seen, const Eigen::Vector3d& tip) noexcept {
  const DrillingHandParameters& p = parameters_;
  const Eigen::Vector3d off = tip - line_start();
  const double sideways = (off - off.dot(p.inward) * p.inward).norm();
  switch (doing_) {
    case Activity::kReach:
      if (sideways < kNear && time_ > kPressing) {
        begin(Activity::kDescend);
      } else if (time_ > kWaitForBone) {  // bone is in the way: over it to the next
        higher_ = std::min(higher_ + p.hover, kHighest);
        next_line();
      }
      break;
    case Activity::kDescend:
      if (seen.contact) {
        if (!surface_known_) {
          surface_known_ = true;
          surface_ = tip.dot(p.inward);
        }
        target_ = line_start();
        begin(Activity::kStroke);
      } else if (time_ > kWaitForBone ||
                 (surface_known_ && tip.dot(p.inward) > surface_ + p.depth)) {
        begin(Activity::kLift);
      }
      break;
    case Activity::kStroke:
      if (time_ > p.width / p.speed) {
        begin(Activity::kLift);
      }
      break;
    case Activity::kLift:
      if (time_ > p.hover / kBetweenStrokes + kPressing) {
        next_line();
      }
      break;
    case Activity::kChange:
      if (seen.tool == wanted_tool_) {
        begin(wanted_tool_ == p.suction_tool ? Activity::kSuck : Activity::kReach);
      }
      break;
    case Activity::kSuck:
      if (time_ > p.suction_time) {
        wanted_tool_ = 0;
        begin(Activity::kChange);
      }
      break;
    case Activity::kLook:
      if (time_ > kLookTime) {
        begin(Activity::kReach);
      }
      break;
  }
}

/// The arm's force: across the press it follows its target, along it presses or keeps a height.
Eigen::Vector3d DrillingHand::push(const bone::DrillingView& seen, const Eigen::Vector3d& tip,
                                   double dt) noexcept {
  const DrillingHandParameters& p = parameters_;
  const Eigen::Vector3d velocity =
      tip_known_ ? Eigen::Vector3d((tip - last_tip_) / dt) : Eigen::Vector3d::Zero();
  const double height = tip.dot(p.inward);
  const double floor = surface_known_ ? surface_ + p.depth : 1.0;
  const double above =
      (surface_known_ ? surface_ : p.start.dot(p.inward) + p.hover) - p.hover - higher_;
  Eigen::Vector3d goal = line_start();
  double inward = 0.0;  // [N]
  const double fall = velocity.dot(p.inward);
  const auto keep = [&](double wanted) { return kStiffness * (wanted - height) - kDamping * fall; };
  switch (doing_) {
    case Activity::kStroke: {
      const double gone = std::min(p.width, p.speed * time_);
      goal += (back_ ? -gone : gone) * p.along;
      const double room = std::clamp((floor - height) / 0.0005, 0.0, 1.0);
      inward = noise_.press(p.press) * room - kDamping * fall;
      break;
    }
    case Activity::kDescend:
      inward = noise_.press(0.0) + kDamping * (kDescent - fall) * (seen.contact ? 0.0 : 3.0);
      break;
    case Activity::kSuck:
      goal = p.start;
      inward = keep(surface_known_ ? surface_ + 0.5 * p.depth : above);
      break;
    case Activity::kLook:
      goal += 0.004 * std::sin(8.0 * time_) * across_;
      inward = keep(above);
      break;
    default:
      inward = keep(above);
  }
  const Eigen::Vector3d error = goal - tip;
  Eigen::Vector3d across = kStiffness * (error - error.dot(p.inward) * p.inward) -
                           kDamping * (velocity - fall * p.inward);
  const double strength = across.norm();
  if (strength > kStrongestAcross) {
    across *= kStrongestAcross / strength;
  }
  return across + std::clamp(inward, -kStrongestAcross, 2.0 * kStrongestAcross) * p.inward;
}

std::uint32_t DrillingHand::fingers(const bone::DrillingView& seen) const noexcept {
  const DrillingHandParameters& p = parameters_;
  const bool down = std::fmod(time_, 2.0 * kPressing) < kPressing;
  switch (doing_) {
    case Activity::kDescend:
    case Activity::kStroke:
    case Activity::kSuck:
      return held(p.power_button);
    case Activity::kChange:
      if (seen.tool == wanted_tool_ || !down) {
        return 0;
      }
      return held(seen.tool < wanted_tool_ ? p.next_button : p.previous_button);
    case Activity::kLook:
      return held(p.look_button);
    default:
      return 0;
  }
}

}  // namespace haptrial::subject
