#include "experiments/command/sessions/certificate_task.h"

#include <algorithm>
#include <cmath>

namespace haptrial::experiments {
namespace {

using analysis::CertificatePart;
using Eigen::Vector3d;

constexpr double kNear = 0.8;         // of the workspace, to which a free handle may fall
constexpr double kHold = 80.0;        // beyond it [N/m]
constexpr double kCalm = 4.0;         // [N·s/m]
constexpr double kSoft = 0.01;        // beyond kNear, over which kCalm grows [m]
constexpr double kPress = 1.0;        // on a wall, of a device that gives it all [N]
constexpr double kMostWall = 4.0;     // of a wall, likewise [N]
constexpr double kBack = 0.003;       // in front of the wall, from which the handle is let go [m]
constexpr double kReady = 0.6;        // shortest time to take it there [s]
constexpr double kLongestBack = 4.0;  // longest, against friction [s]
constexpr double kBackWithin = 8e-4;  // of that place [m]
constexpr double kBackSpeed = 0.005;  // at which it counts as there [m/s]
constexpr double kMostBack = 2.0;     // that takes it there, likewise [N]
constexpr double kGather = 600.0;     // gain of the sum of what is missing [N/(m·s)]
constexpr double kAtWall = 1.2;       // [s]
constexpr double kFar = 0.03;         // further than any swing that is watched [m]
constexpr double kSwing = 3e-4;       // from peak to peak, which counts as one [m]
constexpr double kDying = 0.7;        // a swing that falls to less in a third of the time dies away
constexpr double kStep = 1.3;         // from one wall to the next
constexpr double kClose = 1.08;       // of active and passive, which ends the search
constexpr double kStiffest = 20000;   // that is tried [N/m]

/// @param most  that the device gives there [N]
device::EnvelopeLimits certificate_limits(const device::DeviceInfo& info, double most,
                                          const analysis::Excitation& excitation) {
  device::EnvelopeLimits limits;
  limits.max_force = std::min(most, 1.25 * excitation.max_force());
  limits.max_force_rate = 2.0 * limits.max_force * excitation.rate();  // each tick is commanded
  limits.workspace_radius = 2.0 * info.workspace_radius;
  limits.max_speed = 2.0;
  limits.max_jump = 0.02;
  limits.ramp_in = 0.0;
  limits.max_saturation = 60.0;
  limits.holding_force = 2.0 * excitation.max_force();  // a mount holds the handle
  return limits;
}

bool is_free(CertificatePart part) {
  return part == CertificatePart::kFree || part == CertificatePart::kLoaded;
}

std::size_t index(CertificatePart part) { return static_cast<std::size_t>(part); }

}  // namespace

WallLadder::WallLadder(double rate, int axis, double most) noexcept
    : rate_(rate), axis_(axis), share_(std::min(most / (kMostWall - kPress), 1.0)) {}

Vector3d WallLadder::command(const PointState& tool) noexcept {
  const Vector3d along = Vector3d::Unit(axis_);
  const double x = tool.position[axis_];
  const double v = tool.velocity[axis_];
  if (!pressing_ && !is_ready(x, v)) {
    return taking_back(x, v) * along;
  }
  const auto at_wall = std::lround(kAtWall * rate_);
  const long since = tick_++;
  if (since >= at_wall) {
    judge();
    return taking_back(x, v) * along;
  }
  if (lost_ || std::abs(x) > kFar) {
    lost_ = true;
    return Vector3d::Zero();
  }
  const auto third = static_cast<std::size_t>(std::min(3 * since / at_wall, 2L));
  const bool first = since == 0 || 3 * (since - 1) / at_wall != static_cast<long>(third);
  low_[third] = first ? x : std::min(low_[third], x);
  high_[third] = first ? x : std::max(high_[third], x);
  return (std::min(stiffness_ * std::max(-x, 0.0), share_ * kMostWall) - share_ * kPress) * along;
}

/// Whether the handle is in front of the wall, or the time for it is over; it is let go then.
bool WallLadder::is_ready(double x, double v) noexcept {
  const bool there = std::abs(x - kBack) < kBackWithin && std::abs(v) < kBackSpeed;
  ++tick_;
  if (tick_ < std::lround(kReady * rate_) ||
      !(there || tick_ >= std::lround(kLongestBack * rate_))) {
    return false;
  }
  pressing_ = true;
  released_ = x;
  tick_ = 0;
  return true;
}

/// Against friction the force grows until the handle moves.
double WallLadder::taking_back(double x, double v) noexcept {
  const double error = x - kBack;
  const double wanted = -80.0 * error - 4.0 * v - gathered_;
  const double most = share_ * kMostBack;
  if (std::abs(wanted) < most) {
    gathered_ += kGather * error / rate_;
  }
  return std::clamp(wanted, -most, most);
}

void WallLadder::judge() noexcept {
  const double middle = high_[1] - low_[1];
  const double last = high_[2] - low_[2];
  const bool swings = lost_ || (last > kSwing && last > kDying * middle);
  const bool met =
      lost_ || (released_ > kBack - kBackWithin && std::min({low_[0], low_[1], low_[2]}) < 0.0);
  steps_[count_++] = {stiffness_, met && !swings, met};
  (swings ? active_ : passive_) = stiffness_;
  if (!met || count_ == kMost || (swings && passive_ == 0.0) ||
      (active_ > 0.0 && active_ < kClose * passive_) || stiffness_ >= kStiffest) {
    done_ = true;
  }
  stiffness_ = active_ > 0.0 ? std::sqrt(active_ * passive_) : kStep * stiffness_;
  tick_ = 0;
  pressing_ = lost_ = false;
  gathered_ = 0.0;
}

std::vector<analysis::WallStep> WallLadder::steps() const {
  return {steps_.begin(), steps_.begin() + static_cast<long>(count_)};
}

CertificateTask::CertificateTask(device::Device& device, device::ForceSensor* sensor,
                                 const analysis::Excitation& excitation,
                                 std::vector<CertificatePart> parts, Mount mount, device::Part of,
                                 double radius)
    : device_(device),
      of_(of),
      radius_(radius),
      sensor_(sensor),
      excitation_(excitation),
      envelope_(certificate_limits(device.info(), device::most_force(of, device.info(), radius),
                                   excitation)),
      parts_(std::move(parts)),
      mount_(std::move(mount)),
      walls_(excitation.rate(), excitation.axes().front(), envelope_.limits().max_force) {
  record_.of = of;
  record_.radius = radius;
  record_.axes = excitation.axes();
  record_.device = device.info().name;
  record_.simulated = device.info().simulated;
  for (const CertificatePart part : parts_) {
    const auto ticks = static_cast<std::size_t>(excitation.ticks(part));
    analysis::PartRecord& columns = record_.parts[index(part)];
    columns.command.resize(ticks);
    columns.position.resize(ticks);
    columns.velocity.resize(ticks);
    const std::size_t measured = sensor != nullptr && !is_free(part) ? ticks : 0;
    columns.measured.resize(measured);
    columns.measured_at.resize(measured);
    tick_at_[index(part)].resize(measured);
  }
  shown_.store(parts_.empty() ? CertificatePart::kDone : parts_.front());
}

/// A rotation's or grip's place begins at 0, wherever it is.
bool CertificateTask::read(device::DeviceReading& reading) noexcept {
  if (!device_.read(reading)) {
    return false;
  }
  reading.tool = device::part_state(of_, reading, radius_, place_);
  place_ = reading.tool.position;
  if (!origin_) {
    origin_ = of_ == device::Part::kTip ? Vector3d(Vector3d::Zero()) : place_;
  }
  reading.tool.position -= *origin_;
  return true;
}

bool CertificateTask::write(const Vector3d& force) noexcept {
  device::Wrench wrench;
  device::put_force(of_, force, radius_, wrench);
  return device_.write(wrench);
}

bool CertificateTask::tick(const realtime::Tick& tick) noexcept {
  device::DeviceReading reading;
  const bool read_ok = read(reading);
  device::MeasuredForce measured;  // at the same instant as the reading
  const bool has_force = sensor_ != nullptr && sensor_->read(measured);
  if (envelope_.check(read_ok, reading) != device::Fault::kNone) {
    trouble_ = device_.trouble();
  }
  const bool waits = tick_ == 0 && !mount_ && !start_.load(std::memory_order_acquire);
  Vector3d wanted = Vector3d::Zero();
  if (envelope_.fault() == device::Fault::kNone && at_ < parts_.size() && !waits) {
    wanted = command(reading);
    if (mount_) {
      mount_(parts_[at_], tick_);
    }
  }
  if (stop_.load(std::memory_order_relaxed)) {
    envelope_.trip(device::Fault::kEmergencyStop);
  }
  device::ForceIntent intent;
  intent.push = wanted;
  intent.stimulus = wanted;
  const Vector3d given = envelope_.limit(wanted, tick.dt, intent);
  if (!write(given) && envelope_.fault() == device::Fault::kNone) {
    envelope_.trip(device::Fault::kWriteFailed);
    trouble_ = device_.trouble();
  }
  if (at_ < parts_.size() && !waits) {
    keep(reading, given, has_force ? &measured : nullptr);
    ++tick_;
    const bool wall = parts_[at_] == CertificatePart::kWall;
    if (wall ? walls_.done() : tick_ >= excitation_.ticks(parts_[at_])) {
      end_part();
    }
  }
  const bool more = at_ < parts_.size() && envelope_.fault() == device::Fault::kNone;
  if (!more) {
    write(Vector3d::Zero());
    stopped_.store(true, std::memory_order_release);
    shown_.store(CertificatePart::kDone, std::memory_order_release);
  }
  return more;
}

Vector3d CertificateTask::command(const device::DeviceReading& reading) noexcept {
  const CertificatePart part = parts_[at_];
  Vector3d wanted = excitation_.command(part, tick_);
  if (part == CertificatePart::kWall) {
    wanted = walls_.command(reading.tool) + catching(reading.tool, excitation_.axes().front(), 1.0);
  }
  if (is_free(part)) {
    wanted += excitation_.centring(part, tick_, reading.tool) +
              catching(reading.tool, excitation_.moved_axis(part, tick_),
                       excitation_.centred(part, tick_));
  }
  const double most = envelope_.limits().max_force;
  return wanted.norm() > most ? Vector3d(wanted * (most / wanted.norm())) : wanted;
}

/// Holds a handle that was let go and falls, by weight that is left, where nothing else holds it.
Vector3d CertificateTask::catching(const PointState& tool, int moved,
                                   double centred) const noexcept {
  const double near = of_ == device::Part::kTip ? kNear * device_.info().workspace_radius : kFar;
  Vector3d force = Vector3d::Zero();
  for (const int axis : excitation_.axes()) {
    const double x = tool.position[axis];
    const double depth = std::max(std::abs(x) - near, 0.0);
    const double calm = kCalm * std::min(depth / kSoft, 1.0);
    const double share = axis == moved ? 1.0 - centred : 1.0;
    force[axis] = -share * (kHold * std::copysign(depth, x) + calm * tool.velocity[axis]);
  }
  return force;
}

void CertificateTask::keep(const device::DeviceReading& reading, const Vector3d& given,
                           const device::MeasuredForce* measured) noexcept {
  analysis::PartRecord& columns = record_.parts[index(parts_[at_])];
  const auto row = static_cast<std::size_t>(tick_);
  if (row >= columns.command.size()) {
    return;
  }
  columns.command[row] = given;
  columns.position[row] = reading.tool.position;
  columns.velocity[row] = reading.tool.velocity;
  if (row >= columns.measured.size()) {
    return;
  }
  if (measured != nullptr) {
    columns.measured[row] = measured->force;
    columns.measured_at[row] = measured->time;
    tick_at_[index(parts_[at_])][row] = measured->time + measured->age;
    record_.stated_noise = measured->noise;
  } else {
    unmeasured_[index(parts_[at_])] = true;
  }
}

void CertificateTask::end_part() noexcept {
  tick_ = 0;
  ++at_;
  start_.store(false, std::memory_order_release);
  shown_.store(at_ < parts_.size() ? parts_[at_] : CertificatePart::kDone,
               std::memory_order_release);
}

analysis::CertificateRecord CertificateTask::record() const {
  analysis::CertificateRecord record = record_;
  record.walls = walls_.steps();
  double late = 0.0;
  double ticks = 0.0;
  for (std::size_t part = 0; part < record.parts.size(); ++part) {
    analysis::PartRecord& columns = record.parts[part];
    if (unmeasured_[part]) {
      columns.measured.clear();  // a part with a gap says nothing
      columns.measured_at.clear();
    } else {
      const auto count = static_cast<double>(columns.measured.size());
      late += count * analysis::align_forces(columns, tick_at_[part]);
      ticks += count;
    }
  }
  record.sensor_age = ticks > 0.0 ? late / ticks : 0.0;
  return record;
}

namespace {

/// Share of the device's force that a certificate commands.
constexpr double kForceShare = 0.4;

}  // namespace

double reach_of(device::Part part, double radius, double workspace_radius) {
  constexpr double kTurn = 1.0;       // [rad]
  constexpr double kOpening = 0.008;  // [m]
  switch (part) {
    case device::Part::kRotation:
      return std::min(kTurn * radius, 0.5 * workspace_radius);
    case device::Part::kGrip:
      return std::min(kOpening, 0.5 * workspace_radius);
    case device::Part::kTip:
      break;
  }
  return 0.5 * workspace_radius;
}

analysis::Excitation excitation_of(const protocols::DeviceArm& arm,
                                   const analysis::DrivenAxes& axes, double most,
                                   double workspace_radius) {
  const double force = kForceShare * most;
  return arm.part == device::Part::kTip
             ? analysis::Excitation(kDeviceTestRate, force)
             : analysis::Excitation(kDeviceTestRate, force, axes,
                                    reach_of(arm.part, arm.radius, workspace_radius));
}

double load_of(const DeviceTestOptions& options, const protocols::DeviceArm& arm) {
  return arm.part == device::Part::kTip ? options.mass : 0.0;
}

std::vector<analysis::CertificatePart> parts_without_sensor(const DeviceTestOptions& options,
                                                            const protocols::DeviceArm& arm) {
  std::vector<analysis::CertificatePart> parts{analysis::CertificatePart::kRest,
                                               analysis::CertificatePart::kFree};
  if (load_of(options, arm) > 0.0) {
    parts.push_back(analysis::CertificatePart::kLoaded);
  }
  parts.push_back(analysis::CertificatePart::kWall);
  return parts;
}

}  // namespace haptrial::experiments
