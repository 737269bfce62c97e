#include "core/subject/drilling/osteotomy_hand.h"

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/definition/table_vector.h"
#include "core/base/shortest_turn.h"
#include "core/subject/drilling/drilling_arm.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOver = 6e-3;       // over the bone, between two places [m]
constexpr double kArrived = 1e-3;    // is there [m]
constexpr double kThrough = 4e-3;    // beyond the wanted depth, where the arm draws to [m]
constexpr double kTurning = 1.5;     // [rad/s]
constexpr double kCarrying = 0.008;  // speed of a fragment [m/s]
constexpr double kFeed = 0.012;      // at most, of the saw into bone [m/s]
constexpr double kWithSaw = 0.02;    // [m/s]

SubjectParameters noisy_person(const OsteotomyHandParameters& p) {
  SubjectParameters person;
  person.tremor = p.tremor;
  return person;
}

/// The pose at a place with two of its axes; `z` has unit length and `x` is across it.
Isometry3d pose_with(const Vector3d& place, const Vector3d& x, const Vector3d& z) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear().col(0) = (x - x.dot(z) * z).normalized();
  pose.linear().col(1) = z.cross(pose.linear().col(0));
  pose.linear().col(2) = z;
  pose.translation() = place;
  return pose;
}

Isometry3d shifted(const Isometry3d& pose, const Vector3d& by) {
  Isometry3d to = pose;
  to.translation() += by;
  return to;
}

template <class Kind>
bool has(const bone::ToolSpec& tool) {
  return tool.as<Kind>() != nullptr;
}
bool is_saw(const bone::ToolSpec& tool) {
  const auto* burr = tool.as<bone::BurrTool>();
  return burr != nullptr && burr->burr.form == bone::BurrForm::kBlade;
}

/// @returns its number; -1 where there is none
int first_of(std::span<const bone::ToolSpec> tools, bool (*is)(const bone::ToolSpec&)) {
  const auto found = std::find_if(tools.begin(), tools.end(), is);
  return found == tools.end() ? -1 : static_cast<int>(found - tools.begin());
}

}  // namespace

const Schema<OsteotomyHandParameters>& osteotomy_hand_schema() {
  using P = OsteotomyHandParameters;
  static const auto schema =
      Schema<P>()
          .vector("from", &P::from, {-1.0, 1.0}, "m",
                  "Beginning of the line over the bone along which the virtual hand saws")
          .required()
          .vector("to", &P::to, {-1.0, 1.0}, "m", "End of the line along which it saws")
          .required()
          .direction("inward", &P::inward, "Direction into the bone in which the virtual hand saws")
          .required()
          .number("depth", &P::depth, {1e-4, 0.1}, "m",
                  "Depth of the saw's teeth below the line at the end of a cut")
          .number("spacing", &P::spacing, {1e-4, 0.1}, "m",
                  "Distance between neighbouring cuts of the saw, at most")
          .number("press", &P::press, {0.1, 20.0}, "N",
                  "Force with which the virtual hand presses the saw")
          .vector("grip", &P::grip, {-1.0, 1.0}, "m",
                  "Place at which the virtual hand takes the fragment, on its bone")
          .required()
          .vector("plate", &P::plate, {-1.0, 1.0}, "m",
                  "Middle of the plate on the bone, when the fragment lies as planned")
          .required()
          .direction("plate_out", &P::plate_out, "Direction out of the bone under the plate")
          .required()
          .direction("plate_along", &P::plate_along, "Direction along the plate")
          .required()
          .check([](Table& table, P& p) {
            const auto across = [&](const char* key, const Vector3d& a, const Vector3d& b,
                                    const char* other) {
              if (!(a.cross(b).norm() > 0.1)) {
                table.reject(key, std::string("is nearly the direction of ") + other +
                                      "; write a direction across it");
              }
            };
            across("plate_along", p.plate_along, p.plate_out, "plate_out");
            across("to", (p.to - p.from).stableNormalized(), p.inward, "inward, seen from from");
          })
          .number("tremor", &P::tremor, {0.0, 1.0}, "N",
                  "Root mean square of the virtual hand's tremor")
          .integer("power_button", &P::power_button, 0, 30,
                   "Button of the device with which the virtual hand saws, grips and drives screws")
          .integer("next_button", &P::next_button, 0, 30,
                   "Button of the device with which the virtual hand takes the next tool")
          .integer("apply_button", &P::apply_button, 0, 30,
                   "Button of the device with which the virtual hand fixes a plate")
          .integer("finish_button", &P::finish_button, 0, 30,
                   "Button of the device with which the virtual hand ends the procedure");
  return schema;
}

std::vector<const char*> missing_tools(std::span<const bone::ToolSpec> tools) {
  std::vector<const char*> missing;
  const auto need = [&](bool (*is)(const bone::ToolSpec&), const char* type) {
    if (first_of(tools, is) < 0) {
      missing.push_back(type);
    }
  };
  need(is_saw, "saw");
  need(has<bone::GripTool>, "grip");
  need(has<bone::PlateTool>, "plate");
  need(has<bone::ScrewTool>, "screw");
  return missing;
}

OsteotomyTools osteotomy_tools(std::span<const bone::ToolSpec> tools) {
  OsteotomyTools found;
  found.saw = first_of(tools, is_saw);
  found.grip = first_of(tools, has<bone::GripTool>);
  found.plate = first_of(tools, has<bone::PlateTool>);
  found.screw = first_of(tools, has<bone::ScrewTool>);
  const bone::ToolSpec& plate = tools[static_cast<std::size_t>(found.plate)];
  found.holes = bone::make_plate_model(plate.name, *plate.as<bone::PlateTool>()).holes();
  const auto& driver = *tools[static_cast<std::size_t>(found.screw)].as<bone::ScrewTool>();
  found.screw_time = driver.length / (driver.pitch * driver.turns);
  return found;
}

Vector3d start_of(const OsteotomyHandParameters& p) { return p.from - 2.0 * kOver * p.inward; }

OsteotomyHand::OsteotomyHand(const OsteotomyHandParameters& parameters, const FragmentPlan& plan,
                             const OsteotomyTools& tools, HandModel& hand,
                             device::VirtualDevice& device, const HandFrame& frame,
                             std::uint64_t seed, double step)
    : parameters_(parameters),
      hand_(hand),
      device_(device),
      frame_(frame),
      noise_(noisy_person(parameters), step, RandomStream(seed, "osteotomy hand")) {
  plan_cuts(plan, tools);
  plan_move(plan, tools);
  plan_plate(tools);
  target_ = acts_.front().goal;
}

void OsteotomyHand::add(ToolAction act, const Isometry3d& goal) {
  act.goal = goal;
  acts_.push_back(act);
}

/// Cuts side by side along the line, each from over the bone to the depth and out again.
void OsteotomyHand::plan_cuts(const FragmentPlan& plan, const OsteotomyTools& tools) {
  const OsteotomyHandParameters& p = parameters_;
  const Vector3d line = p.to - p.from;
  const int cuts = 1 + static_cast<int>(std::ceil(line.norm() / p.spacing));
  for (int cut = 0; cut < cuts; ++cut) {
    const Vector3d across = plan.normal.cross(p.inward);
    const Isometry3d over =
        pose_with(p.from + (cuts > 1 ? cut / (cuts - 1.0) : 0.5) * line, across, -p.inward);
    const Isometry3d out = shifted(over, -kOver * p.inward);
    ToolAction reach{.tool = tools.saw};
    add(reach, out);
    ToolAction saw{
        .tool = tools.saw, .speed = kFeed, .strength = p.press, .most = 10.0, .power = true};
    saw.depth = (p.depth + over.translation().dot(p.inward));
    add(saw, shifted(over, (p.depth + kThrough) * p.inward));
    ToolAction back{.tool = tools.saw, .speed = kWithSaw, .power = true};
    add(back, out);
  }
}

/// Takes the fragment and leads it along the planned motion.
void OsteotomyHand::plan_move(const FragmentPlan& plan, const OsteotomyTools& tools) {
  const OsteotomyHandParameters& p = parameters_;
  const Isometry3d at = pose_with(p.grip, p.plate_along, p.plate_out);
  const Isometry3d moved = plan.motion() * at;
  add({.tool = tools.grip}, shifted(at, kOver * p.plate_out));
  add({.tool = tools.grip, .speed = kWithSaw, .least = 0.5}, at);
  add({.tool = tools.grip, .speed = kCarrying, .least = 1.0, .most = 10.0, .power = true}, moved);
  add({.tool = tools.grip, .least = 0.2}, moved);
  add({.tool = tools.grip}, shifted(moved, kOver * p.plate_out));
}

/// Lays the plate on, fixes it, drives the screws, and says that it is done.
void OsteotomyHand::plan_plate(const OsteotomyTools& tools) {
  const OsteotomyHandParameters& p = parameters_;
  const Isometry3d on = pose_with(p.plate, p.plate_along, p.plate_out);
  const Isometry3d over = shifted(on, kOver * p.plate_out);
  add({.tool = tools.plate}, over);
  add({.tool = tools.plate, .speed = kWithSaw, .least = 0.5}, on);
  add({.tool = tools.plate, .least = 2.0 * kPressing, .button = p.apply_button}, on);
  add({.tool = tools.plate}, over);
  for (const Isometry3d& hole : tools.holes) {
    const Isometry3d at = on * hole;
    add({.tool = tools.screw}, shifted(at, kOver * p.plate_out));
    add({.tool = tools.screw, .least = 0.1}, at);
    const double time = tools.screw_time + 0.2;
    add({.tool = tools.screw, .least = time, .most = time + 2.0, .power = true}, at);
    add({.tool = tools.screw}, shifted(at, kOver * p.plate_out));
  }
  const Isometry3d end = acts_.back().goal;
  add({.tool = tools.screw, .least = 10.0, .most = 10.0, .button = p.finish_button}, end);
}

bool OsteotomyHand::is_done(const ToolAction& act, const Vector3d& tip) const noexcept {
  if (act.depth != 0.0) {
    return tip.dot(parameters_.inward) >= act.depth || time_ > act.most;
  }
  return time_there_ > act.least || time_ > std::max(act.most, act.least);
}

/// Leads the target to the goal at the act's speed.
void OsteotomyHand::approach(const ToolAction& act, double dt) noexcept {
  const Vector3d way = act.goal.translation() - target_.translation();
  const double length = way.norm();
  const double most = act.speed * dt;
  target_.translation() = length > most ? Vector3d(target_.translation() + most / length * way)
                                        : Vector3d(act.goal.translation());
  const Eigen::Quaterniond from(target_.linear());
  const Eigen::Quaterniond to(act.goal.linear());
  const double angle = from.angularDistance(to);
  const double share = angle > kTurning * dt ? kTurning * dt / angle : 1.0;
  target_.linear() = from.slerp(share, to).normalized().toRotationMatrix();
}

void OsteotomyHand::observe(const stimulus::Shown& shown, const stimulus::Forces&,
                            double dt) noexcept {
  const auto* seen = shown.as<bone::DrillingView>();
  if (seen == nullptr || !seen->shown) {
    hand_.command({0.0, false, noise_.tremor()});
    device_.hold(0, 0.0, Eigen::Quaterniond::Identity());
    begun_ = false;
    return;
  }
  const ToolAction& act = acts_[at_];
  const bool has_tool = seen->tool == act.tool;
  if (has_tool) {
    approach(act, dt);
  }
  const Vector3d tip = frame_.scale * seen->tip;
  const Vector3d velocity = begun_ ? Vector3d((tip - last_tip_) / dt) : Vector3d::Zero();
  Vector3d force = kStiffness * (frame_.scale * target_.translation() - tip);
  const double strength = force.norm();
  force *= strength > act.strength ? act.strength / strength : 1.0;
  HandCommand command;
  command.force = force - kDamping * velocity + noise_.tremor();
  hand_.command(command);
  const Eigen::Quaterniond tool(target_.linear());
  const Eigen::Quaterniond grip = shortest_turn(Vector3d::UnitZ(), frame_.handle);
  device_.hold(fingers(act, *seen), 0.0, tool * grip.conjugate());
  last_tip_ = tip;
  begun_ = true;
  time_ += dt;
  const bool there = has_tool && (seen->tip - act.goal.translation()).norm() < kArrived &&
                     target_.linear().isApprox(act.goal.linear(), 1e-6);
  time_there_ = there ? time_there_ + dt : 0.0;
  if (has_tool && is_done(act, seen->tip) && at_ + 1 < acts_.size()) {
    ++at_;
    time_ = 0.0;
    time_there_ = 0.0;
  }
}

std::uint32_t OsteotomyHand::fingers(const ToolAction& act,
                                     const bone::DrillingView& seen) const noexcept {
  const bool down = std::fmod(time_, 2.0 * kPressing) < kPressing;
  if (seen.tool != act.tool) {
    return down ? held(parameters_.next_button) : 0U;
  }
  const std::uint32_t power = act.power ? held(parameters_.power_button) : 0U;
  return power | (act.button >= 0 && down ? held(act.button) : 0U);
}

}  // namespace haptrial::subject
