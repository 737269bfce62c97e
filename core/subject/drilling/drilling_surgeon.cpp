#include "core/subject/drilling/drilling_surgeon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/subject/drilling/drilling_arm.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {
namespace {

constexpr double kAhead = 0.06;          // that it looks ahead [s]
constexpr double kBackOut = 1500.0;      // where it went too deep [N/m]
constexpr double kDrag = 40.0;           // of the hand itself, that it knows to push against
constexpr double kFriction = 0.1;        // of the handle, that it has learnt to overcome [N]
constexpr double kStrongest = 6.0;       // of the arm [N]
constexpr double kStrongestAside = 1.5;  // while it drills [N]
constexpr double kVelocityTime = 8e-3;   // over which it feels its velocity [s]
constexpr double kTravel = 0.12;         // [m/s]
constexpr double kDown = 0.08;           // through the air [m/s]
constexpr double kOnto = 0.012;          // close to the bone [m/s]
constexpr double kHover = 1e-3;          // over what it passes [m]
constexpr double kThere = 1.5e-3;        // [m]
constexpr double kShell = 1.0e-3;        // that is left to the fine burr beyond the margin [m]
constexpr double kLookLonger = 3.0;      // than this nobody tries [s]
constexpr double kLookRate = 0.15;       // of the hand for an error of the view [m/(s·rad)]
constexpr double kRoomToLook = 0.03;     // over the bone for a hand that turns the view [m]
constexpr double kArm = 0.06;            // from the middle, as far as it turns the view [m]
constexpr double kSeenWell = 0.06;       // [rad]
constexpr double kWorthALook = 0.6;      // [rad]
constexpr double kPatience = 1.0;        // strokes without bone under the burr
constexpr double kRoughShare = 0.9;      // of the completeness
constexpr double kWithdrawn = 4e-3;      // after a tone of the nerve monitor [m]
constexpr double kQuiet = 1.0;           // that it waits then [s]
constexpr double kCortexDepth = 3e-3;    // below the surface that the bone had [m]
constexpr double kMiddleDepth = 8e-3;    // likewise [m]
constexpr double kUnderBite = 0.5e-3;    // of strokes under an edge [m]
constexpr double kUnderStep = 0.25e-3;   // along them, from one look at the chart to the next [m]
constexpr int kSweeps = 6;               // of a bout
constexpr int kSweepsUnder = 4;

MotorNoise noise_of(const DrillingSkill& skill, double step, std::uint64_t seed) {
  SubjectParameters person;
  person.force_noise = skill.force_noise;
  person.tremor = skill.tremor;
  return {person, step, RandomStream(seed, "drilling hand")};
}

Eigen::Vector3d saturated(const Eigen::Vector3d& force, double most) noexcept {
  const double size = force.norm();
  return size > most ? Eigen::Vector3d(force * (most / size)) : force;
}

}  // namespace

DrillingSurgeon::Procedure DrillingSurgeon::plan(const SurgeonParameters& p,
                                                 std::shared_ptr<const DrillingChart> chart,
                                                 std::uint64_t seed, int number, double step) {
  const std::uint64_t own = derived_seed(seed, fmt::format("procedure {}", number + 1));
  const double skill_number = skill_in(p.skill, p.spread, seed, number);
  const DrillingSkill skill = drilling_skill(skill_number);
  RandomStream random(own, "plan");
  CavityView view;
  view.offset =
      skill.misjudgement * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  view.shift = skill.region_error * Eigen::Vector2d(random.normal(), random.normal());
  view.slope = skill.saucer;
  view.extra = skill.extra_margin;
  const bool careful = random.uniform() < skill.careful;
  BurrReach rough;
  BurrReach fine;
  if (careful) {
    fine = burr_reach(*chart, cavity_floor(*chart, view), p.fine.radius);
    CavityView safe = view;
    safe.extra += kShell;
    rough = burr_reach(*chart, cavity_floor(*chart, safe), p.rough.radius);
  } else {
    rough = burr_reach(*chart, cavity_floor(*chart, view), p.rough.radius);
  }
  const DrillingChart& drawn = *chart;
  return {std::move(chart),
          skill_number,
          skill,
          view,
          careful,
          std::move(rough),
          std::move(fine),
          noise_of(skill, step, own),
          RandomStream(own, "work"),
          HintHeeding(p.heeds, p.reaction, RandomStream(own, "hints")),
          DrillingMemory(drawn)};
}

DrillingSurgeon::DrillingSurgeon(const SurgeonParameters& parameters,
                                 std::vector<std::shared_ptr<const DrillingChart>> charts,
                                 HandModel& hand, device::VirtualDevice& device, double scale,
                                 std::uint64_t seed, double step, WorkLog* work)
    : parameters_(parameters), hand_(hand), device_(device), scale_(scale), work_(work) {
  if (charts.empty()) {
    throw std::invalid_argument("DrillingSurgeon: there must be a chart");
  }
  for (auto& chart : charts) {
    procedures_.push_back(plan(parameters_, std::move(chart), seed,
                               parameters_.earlier + static_cast<int>(procedures_.size()), step));
  }
}

void DrillingSurgeon::begin(Activity doing) noexcept {
  doing_ = doing;
  time_ = 0.0;
}

void DrillingSurgeon::begin_procedure() noexcept {
  at_ = std::min<std::size_t>(static_cast<std::size_t>(begun_), procedures_.size() - 1);
  ++begun_;
  fine_ = false;
  looks_ = false;
  now().memory.begin(now().chart->surface);
  now().memory.begin_burr(now().rough, parameters_.rough.radius);
}

void DrillingSurgeon::observe(const stimulus::Shown& shown, const stimulus::Forces&,
                              double dt) noexcept {
  const auto* seen = shown.as<bone::DrillingView>();
  if (seen == nullptr || !seen->shown) {
    hand_.command({0.0, false, now().noise.tremor()});
    device_.hold(0, 0.0, Eigen::Quaterniond::Identity());
    works_ = false;
    place_known_ = false;
    return;
  }
  const bone::DrillingView& view = *seen;
  const Eigen::Vector3d place = now().chart->place(view.tip);
  if (!works_) {
    // One that was broken off goes on: time has passed already when it begins.
    if (begun_ == 0 || view.progress * view.time_limit < 0.05) {
      begin_procedure();
    }
    works_ = true;
    goal_ = now().chart->place(view.tip);
    next_strokes(view);
  }
  velocity_ =
      place_known_
          ? Eigen::Vector3d(velocity_ + (dt / kVelocityTime) * ((place - last_) / dt - velocity_))
          : Eigen::Vector3d::Zero();
  last_ = place;
  place_known_ = true;
  if (view.power && (doing_ == Activity::kDescend || doing_ == Activity::kStrokes) &&
      !strokes_.under) {
    now().memory.sweep(place);
  }
  listen(view, place, dt);
  heed(view, dt);
  decide(view, place);
  move_goal(view, dt);
  HandCommand command;
  command.force = now().chart->axes * push(view, place) + now().noise.tremor();
  hand_.command(command);
  device_.hold(fingers(view), 0.0, Eigen::Quaterniond::Identity());
  time_ += dt;
}

/// Off the bone when the monitor has sounded for as long as it takes to react.
void DrillingSurgeon::listen(const bone::DrillingView& seen, const Eigen::Vector3d& place,
                             double dt) noexcept {
  const bool works = doing_ == Activity::kDescend || doing_ == Activity::kStrokes;
  heard_ = works && (seen.tone || heard_ > 0.0) ? heard_ + dt : 0.0;
  if (heard_ < parameters_.reaction) {
    return;
  }
  heard_ = 0.0;
  if (doing_ == Activity::kStrokes) {
    now().memory.end_strokes(strokes_);
  }
  lift_to_ = place.z() - kWithdrawn;
  begin(Activity::kWithdraw);
}

/// Drilling ends if the tip is too fast, or hidden; with less force it goes on.
void DrillingSurgeon::heed(const bone::DrillingView& seen, double dt) noexcept {
  if (now().heeding.notice(seen.hints, dt) && doing_ == Activity::kStrokes) {
    now().memory.end_strokes(strokes_);
    begin(Activity::kPause);
  }
}

bool DrillingSurgeon::wants_to_look(const bone::DrillingView& seen) noexcept {
  Procedure& p = now();
  if (parameters_.look_button < 0) {
    return false;
  }
  // The approach goes through the middle of the opening, so that the least bone is in the way.
  const DrillingChart& chart = *p.chart;
  const Eigen::Vector2d middle = 0.5 * (strokes_.from + strokes_.to);
  const Eigen::Vector3d there(middle.x(), middle.y(), p.memory.touch(middle) + burr().radius);
  Eigen::Vector3d outside = p.memory.opening();
  outside.z() -= 0.02;
  Eigen::Vector3d wanted = (chart.world(outside) - chart.world(there)).normalized();
  const Eigen::Vector3d now_from = (seen.eye - seen.target).normalized();
  const bool hidden = std::acos(std::clamp(wanted.dot(now_from), -1.0, 1.0)) > kWorthALook;
  const bool told = p.heeding.looks();
  if (!told && (!hidden || p.random.uniform() >= p.skill.looking)) {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis) {
    wanted[axis] += p.skill.look_error * p.random.normal();
  }
  look_ = wanted.normalized();
  return true;
}

void DrillingSurgeon::next_strokes(const bone::DrillingView& seen) noexcept {
  Procedure& p = now();
  // Bone that the rough burr leaves is for the fine one.
  const double share = p.careful && !fine_ ? kRoughShare : 1.0;
  const bool enough = p.memory.left() < 1.0 - share * p.skill.completeness;
  const StrokeChoice choice{p.skill.evenness, p.skill.stroke_length, p.skill.bite,
                            p.heeding.looks() ? 0.0 : p.skill.undercut};
  if (enough || !p.memory.choose(choice, last_.head<2>(), p.random, strokes_)) {
    lift_to_ = p.memory.opening().z() - 4.0 * parameters_.rough.radius;
    if (p.careful && !fine_) {
      fine_ = true;
      p.memory.begin_burr(p.fine, parameters_.fine.radius);
      begin(Activity::kChange);
    } else {
      begin(Activity::kFinish);
    }
    return;
  }
  if (strokes_.under && !end_before_margin()) {
    StrokeChoice open = choice;
    open.undercut = 0.0;
    p.memory.choose(open, last_.head<2>(), p.random, strokes_);
  }
  if (work_ != nullptr) {
    work_->note(seen.progress * seen.time_limit, work());
  }
  looks_ = wants_to_look(seen);
  lift_to_ = p.memory.over(last_.head<2>(), strokes_.from) - kHover;
  if (looks_) {
    lift_to_ = std::min(lift_to_, p.memory.opening().z() - kRoomToLook);
  }
  begin(Activity::kLift);
}

/// Ends strokes under an edge before the burr would enter a margin, if the structures are where
/// they are believed.
/// @returns false if what is left of them is not worth a stroke.
bool DrillingSurgeon::end_before_margin() noexcept {
  const Procedure& p = now();
  const Eigen::Vector2d way = strokes_.to - strokes_.from;
  const double depth = p.memory.touch(strokes_.from) + kUnderBite;
  const double least = burr().radius + p.view.extra;
  const int steps = static_cast<int>(way.norm() / kUnderStep);
  for (int s = 0; s <= steps; ++s) {
    const Eigen::Vector2d at = strokes_.from + way * s / std::max(1, steps);
    const Eigen::Vector3d place(at.x(), at.y(), depth);
    if (static_cast<double>(p.chart->clearance_at(place - p.view.offset)) < least) {
      strokes_.to = strokes_.from + way * std::max(0, s - 1) / std::max(1, steps);
      break;
    }
  }
  return (strokes_.to - strokes_.from).norm() > burr().radius;
}

/// The bout that was chosen is for this work.
SurgeonWork DrillingSurgeon::work() const noexcept {
  if (fine_) {
    return SurgeonWork::kFine;
  }
  const DrillingChart& chart = *now().chart;
  const Eigen::Vector2d middle = 0.5 * (strokes_.from + strokes_.to);
  const Eigen::Array2i cell = (middle.array() / chart.cell).round().cast<int>();
  const int u = std::clamp(cell.x(), 0, chart.size[0] - 1);
  const int v = std::clamp(cell.y(), 0, chart.size[1] - 1);
  const auto surface = static_cast<double>(chart.surface[chart.column(u, v)]);
  const double depth = now().memory.touch(middle) + burr().radius - surface;
  return depth < kCortexDepth   ? SurgeonWork::kCortex
         : depth < kMiddleDepth ? SurgeonWork::kMiddle
                                : SurgeonWork::kDeep;
}

void DrillingSurgeon::decide(const bone::DrillingView& seen,
                             const Eigen::Vector3d& place) noexcept {
  Procedure& p = now();
  switch (doing_) {
    case Activity::kLift:
      if (place.z() < lift_to_ + kThere) {
        begin(looks_ ? Activity::kLook : Activity::kTravel);
      }
      break;
    case Activity::kTravel:
      if ((place.head<2>() - strokes_.from).norm() < kThere || time_ > kLookLonger) {
        begin(Activity::kDescend);
      }
      break;
    case Activity::kDescend:
      if (seen.contact || place.z() > depth_limit(place) - 0.3e-3 || time_ > kLookLonger) {
        stroke_depth_ = place.z();
        idle_ = 0.0;
        ++series_;
        stroke_rate_ = pace(place);
        begin(Activity::kStrokes);
      }
      break;
    case Activity::kStrokes:
      decide_strokes(seen, place);
      break;
    case Activity::kPause:
      if (time_ > p.skill.pause) {
        next_strokes(seen);
      }
      break;
    case Activity::kLook: {
      const Eigen::Vector3d from = (seen.eye - seen.target).normalized();
      const bool low = place.z() > p.memory.opening().z() - 2.0 * parameters_.rough.radius;
      if (std::acos(std::clamp(look_.dot(from), -1.0, 1.0)) < kSeenWell || time_ > kLookLonger ||
          low || (seen.tip * scale_).norm() > kArm) {
        looks_ = false;
        lift_to_ = p.memory.over(place.head<2>(), strokes_.from) - kHover;
        begin(Activity::kLift);
      }
      break;
    }
    case Activity::kChange:
      if (seen.tool == burr().tool && place.z() < lift_to_ + kThere) {
        next_strokes(seen);
      }
      break;
    case Activity::kWithdraw:
      if (time_ > kQuiet && !seen.tone) {
        next_strokes(seen);
      }
      break;
    case Activity::kFinish:
      break;
  }
}

void DrillingSurgeon::decide_strokes(const bone::DrillingView& seen,
                                     const Eigen::Vector3d& place) noexcept {
  const int sweeps = strokes_.under ? kSweepsUnder : kSweeps;
  const bool at_bottom = place.z() > depth_limit(place) - 0.2e-3;
  idle_ = seen.contact && !at_bottom ? 0.0 : idle_ + 1e-3;
  if (time_ * stroke_rate_ > sweeps || (!strokes_.under && idle_ * stroke_rate_ > kPatience)) {
    now().memory.end_strokes(strokes_);
    begin(Activity::kPause);
  }
}

void DrillingSurgeon::go_to(const Eigen::Vector3d& place, double speed, double dt) noexcept {
  const Eigen::Vector3d way = place - goal_;
  const double length = way.norm();
  const double step = std::min(length, speed * dt);
  const Eigen::Vector3d direction =
      length > 0.0 ? Eigen::Vector3d(way / length) : Eigen::Vector3d::Zero();
  goal_ += step * direction;
  goal_velocity_ = step / dt * direction;
}

/// Follows a bout to and fro, each stroke beginning and ending at rest, and a little beside the one
/// before.
void DrillingSurgeon::follow_strokes() noexcept {
  const double rate = stroke_rate_;
  const double strokes = time_ * rate;
  const int stroke = static_cast<int>(strokes);
  const double angle = std::numbers::pi * strokes;
  const Eigen::Vector2d way = strokes_.to - strokes_.from;
  const Eigen::Vector2d middle = strokes_.from + 0.5 * way;
  const Eigen::Vector2d aside = Eigen::Vector2d(-way.y(), way.x()).normalized();
  const double beside = strokes_.under ? 0.0 : 0.4 * burr().radius * (stroke % 3 - 1);
  goal_.head<2>() = middle - 0.5 * std::cos(angle) * way + beside * aside;
  goal_.z() = last_.z();
  goal_velocity_.head<2>() = 0.5 * std::numbers::pi * rate * std::sin(angle) * way;
  goal_velocity_.z() = 0.0;
}

void DrillingSurgeon::move_goal(const bone::DrillingView& seen, double dt) noexcept {
  const auto at = [](const Eigen::Vector2d& uv, double w) {
    return Eigen::Vector3d(uv.x(), uv.y(), w);
  };
  switch (doing_) {
    case Activity::kLift:
    case Activity::kChange:
    case Activity::kWithdraw:
    case Activity::kFinish:
      go_to(at(goal_.head<2>(), lift_to_), kTravel, dt);
      break;
    case Activity::kTravel:
      go_to(at(strokes_.from, lift_to_), kTravel, dt);
      break;
    case Activity::kDescend: {
      const bool near = last_.z() > now().memory.touch(strokes_.from) - kHover;
      const double depth = std::min(depth_limit(last_), last_.z() + 2e-3);
      go_to(at(strokes_.from, depth), near ? kOnto : kDown, dt);
      break;
    }
    case Activity::kStrokes:
      follow_strokes();
      break;
    case Activity::kPause:
      go_to(at(goal_.head<2>(), last_.z()), kTravel, dt);
      break;
    case Activity::kLook: {
      const Eigen::Vector3d back = (seen.eye - seen.target).normalized();
      const Eigen::Vector3d right = seen.up.cross(back).normalized();
      const Eigen::Vector3d error = look_ - back;
      // The hand's x turns the eye to the right, its y up.
      const Eigen::Vector3d hand(error.dot(right), error.dot(back.cross(right)), 0.0);
      const Eigen::Vector3d motion = now().chart->axes.transpose() * (kLookRate * hand);
      goal_ += dt * motion;
      goal_velocity_ = motion;
      break;
    }
  }
}

/// 0 close to where a structure is believed to be, 1 far from any, by the distance from the burr's
/// underside and sides.
double DrillingSurgeon::far_share(const Eigen::Vector3d& place) const noexcept {
  const Procedure& p = now();
  const double r = burr().radius;
  float nearest = 1.0F;
  for (const Eigen::Vector3d& side :
       {Eigen::Vector3d(0, 0, r), Eigen::Vector3d(r, 0, 0), Eigen::Vector3d(-r, 0, 0),
        Eigen::Vector3d(0, r, 0), Eigen::Vector3d(0, -r, 0)}) {
    nearest = std::min(nearest, p.chart->clearance_at(place + side - p.view.offset));
  }
  const DrillingSkill& k = p.skill;
  return std::clamp(
      (static_cast<double>(nearest) - k.near_distance) / (k.far_distance - k.near_distance), 0.0,
      1.0);
}

/// Lighter the nearer a structure is believed.
double DrillingSurgeon::press(const Eigen::Vector3d& place) const noexcept {
  const DrillingSkill& k = now().skill;
  return now().heeding.lightness() *
         (k.near_force + far_share(place) * (k.far_force - k.near_force));
}

/// Strokes at a place, per second: slower near a structure. [1/s]
double DrillingSurgeon::pace(const Eigen::Vector3d& place) const noexcept {
  const DrillingSkill& k = now().skill;
  return k.stroke_rate * (k.near_pace + far_share(place) * (1.0 - k.near_pace)) *
         now().heeding.pace();
}

double DrillingSurgeon::depth_limit(const Eigen::Vector3d& place) const noexcept {
  const Procedure& p = now();
  if (strokes_.under) {
    return p.memory.touch(strokes_.from) + kUnderBite;
  }
  // Beside the bone there is nothing to stop at.
  const double begun =
      doing_ == Activity::kStrokes ? stroke_depth_ : p.memory.touch(strokes_.from) + kHover;
  // A wall is met before the burr is in it.
  const Eigen::Vector2d soon = place.head<2>() + kAhead * velocity_.head<2>();
  const double limit = std::min(p.memory.limit(place.head<2>()), p.memory.limit(soon));
  return std::min(limit, begun + p.skill.bite);
}

Eigen::Vector3d DrillingSurgeon::push(const bone::DrillingView& seen,
                                      const Eigen::Vector3d& place) noexcept {
  const Eigen::Vector3d follow = kStiffness * scale_ * (goal_ - place) +
                                 kDamping * scale_ * (goal_velocity_ - velocity_) +
                                 kDrag * scale_ * goal_velocity_;
  if (doing_ != Activity::kStrokes) {
    return saturated(follow, kStrongest);
  }
  const double room = depth_limit(place) - place.z();
  const double fall = scale_ * velocity_.z();
  double inward = 0.0;
  if (room < 0.0) {
    inward = kBackOut * scale_ * room - kDamping * fall;
  } else if (seen.contact) {
    const double gate = std::min(1.0, room / 0.3e-3);
    inward = now().noise.press(press(place)) * gate + kFriction - kDamping * fall;
  } else {
    const double wanted = std::min(kOnto, 10.0 * room) * scale_;
    inward = (kDamping + kDrag) * (wanted - fall) + kDrag * fall;
  }
  // Whoever is too deep comes out first, instead of cutting on into the wall.
  const double ease = std::clamp(1.0 + room / 0.5e-3, 0.1, 1.0);
  const double most = ease * std::min(kStrongestAside, 2.0 * press(place) + 0.3);
  Eigen::Vector3d force = saturated(Eigen::Vector3d(follow.x(), follow.y(), 0.0), most);
  force.z() = std::clamp(inward, -kStrongest, kStrongest);
  return force;
}

std::uint32_t DrillingSurgeon::fingers(const bone::DrillingView& seen) const noexcept {
  const bool down = std::fmod(time_, 2.0 * kPressing) < kPressing;
  const SurgeonParameters& p = parameters_;
  switch (doing_) {
    case Activity::kDescend:
    case Activity::kStrokes:
      return seen.tool == burr().tool ? held(p.power_button) : 0U;
    case Activity::kLook:
      return held(p.look_button);
    case Activity::kChange:
      if (seen.tool == burr().tool || !down) {
        return 0;
      }
      return held(seen.tool < burr().tool ? p.next_button : p.previous_button);
    case Activity::kFinish:
      return down ? held(p.finish_button) : 0U;
    default:
      return 0;
  }
}

}  // namespace haptrial::subject
