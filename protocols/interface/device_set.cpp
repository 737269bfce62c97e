#include "protocols/interface/device_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/control/pd_controller.h"

namespace haptrial::protocols {

using device::Fault;

DeviceSet::DeviceSet(const std::vector<Arm>& arms, const control::HandleLoop& loop) : loop_(loop) {
  if (arms.empty() || arms.size() > kMostDevices) {
    throw std::invalid_argument(
        fmt::format("DeviceSet: {} devices; allowed: 1 to {}", arms.size(), kMostDevices));
  }
  for (const Arm& arm : arms) {
    const bool of_a_tip = std::ranges::any_of(arms_, [&](const Arm& before) {
      return before.device == arm.device && before.part == device::Part::kTip;
    });
    if (arm.part != device::Part::kTip && !(of_a_tip && arm.radius > 0.0)) {
      throw std::invalid_argument(
          "DeviceSet: a rotation or grip comes after its device's tip, with a radius above 0");
    }
    arms_.push_back(arm);
    envelopes_.emplace_back(arm.limits);
    guards_.emplace_back(loop_of(arm));
  }
  readings_.resize(arms.size());
  forces_.resize(arms.size(), Eigen::Vector3d::Zero());
  stimuli_.resize(arms.size(), Eigen::Vector3d::Zero());
}

control::HandleLoop DeviceSet::loop_of(const Arm& arm) const {
  control::HandleLoop loop = loop_;
  loop.handle_mass = arm.handle_mass.value_or(loop.handle_mass);
  return loop;
}

/// A device is read once, for its tip; its other parts are taken from that reading.
void DeviceSet::read(std::size_t arm, const SessionInputs& inputs) noexcept {
  device::DeviceReading& reading = readings_[arm];
  bool read_ok = true;
  if (arms_[arm].part == device::Part::kTip) {
    read_ok = arms_[arm].device->read(reading);
    reading.keys = inputs.keys;
    reading.typed = inputs.typed;
    reading.pointer = inputs.pointer;
    reading.pedal = inputs.pedal.value_or(reading.pedal);
    reading.channels = inputs.channels;
    reading.arrived = inputs.arrived;
  } else {
    const Eigen::Vector3d before = reading.tool.position;
    reading = readings_[tip_of(arm)];
    reading.tool = device::part_state(arms_[arm].part, reading, arms_[arm].radius, before);
  }
  envelopes_[arm].check(read_ok, reading);
}

std::size_t DeviceSet::tip_of(std::size_t arm) const noexcept {
  std::size_t tip = 0;
  while (arms_[tip].device != arms_[arm].device) {
    ++tip;
  }
  return tip;
}

void DeviceSet::read(const SessionInputs& inputs, double dt) noexcept {
  for (std::size_t arm = 0; arm < arms_.size(); ++arm) {
    read(arm, inputs);
    readings_[arm].shares =
        guards_[arm].watch(readings_[arm].tool.velocity, forces_[arm], stimuli_[arm], dt);
  }
  note_trouble();
  stop_together();
}

void DeviceSet::limit(const PassOutput& wanted, std::span<const Drive> others, double dt) noexcept {
  limit(0, wanted, dt);
  for (std::size_t arm = 1; arm < arms_.size(); ++arm) {
    static const Drive kNothing;
    limit(arm, arm <= others.size() ? others[arm - 1] : kNothing, dt);
  }
  stop_together();
}

/// Forces along axes that the device lacks are left out, before they count as given. The guard's
/// damper never makes a force too large that the protocol keeps within the limit.
void DeviceSet::limit(std::size_t arm, const Drive& drive, double dt) noexcept {
  device::Envelope& envelope = envelopes_[arm];
  const Eigen::Vector3d axes = device::part_axes(arms_[arm].part, arms_[arm].device->info());
  const Eigen::Vector3d force = drive.force.cwiseProduct(axes);
  device::ForceIntent intent = drive.intent;
  intent.stimulus = intent.stimulus.cwiseProduct(axes);
  intent.ended = intent.ended.cwiseProduct(axes);
  const double most = std::max(std::min(envelope.limits().max_force, drive.most), force.norm());
  const Eigen::Vector3d calm = control::saturate(force + guards_[arm].calming(), most);
  if (drive.goes_over) {
    envelope.go_over();
  }
  forces_[arm] = envelope.limit(calm, dt, intent);
  stimuli_[arm] = intent.stimulus;
}

/// A fault of one device is one of all: none of them goes on with its force.
void DeviceSet::stop_together() noexcept {
  if (arms_.size() == 1 || fault() == Fault::kNone) {
    return;
  }
  for (device::Envelope& envelope : envelopes_) {
    if (envelope.fault() == Fault::kNone) {
      envelope.trip(Fault::kOtherDevice);
    }
  }
  drop();
}

void DeviceSet::drop() noexcept {
  std::fill(forces_.begin(), forces_.end(), Eigen::Vector3d::Zero());
}

device::Wrench DeviceSet::wrench_of(std::size_t tip) const noexcept {
  device::Wrench wrench;
  for (std::size_t arm = tip; arm < arms_.size(); ++arm) {
    if (arms_[arm].device == arms_[tip].device) {
      device::put_force(arms_[arm].part, forces_[arm], arms_[arm].radius, wrench);
    }
  }
  return wrench;
}

bool DeviceSet::write() noexcept {
  bool taken = true;
  for (std::size_t arm = 0; arm < arms_.size(); ++arm) {
    if (arms_[arm].part == device::Part::kTip && !arms_[arm].device->write(wrench_of(arm))) {
      envelopes_[arm].trip(Fault::kWriteFailed);
      taken = false;
    }
  }
  note_trouble();
  if (!taken && arms_.size() > 1) {
    stop_together();
    for (const Arm& arm : arms_) {
      arm.device->write(device::Wrench{});
    }
  }
  return taken;
}

/// Notes the device's message at once: the next read that goes well forgets it.
void DeviceSet::note_trouble() noexcept {
  const bool faulty_now = fault() != Fault::kNone;
  if (faulty_now && !noted_) {
    trouble_ = arms_[faulty()].device->trouble();
  } else if (!faulty_now) {
    trouble_ = "";
  }
  noted_ = faulty_now;
}

bool DeviceSet::without_force() const noexcept {
  return std::all_of(forces_.begin(), forces_.end(),
                     [](const Eigen::Vector3d& force) { return force.isZero(0.0); });
}

void DeviceSet::trip(Fault fault, const char* trouble) noexcept {
  if (*trouble != '\0' && this->fault() == Fault::kNone) {
    trouble_ = trouble;
    noted_ = true;
  }
  for (device::Envelope& envelope : envelopes_) {
    envelope.trip(fault);
  }
}

void DeviceSet::reset() noexcept {
  for (device::Envelope& envelope : envelopes_) {
    envelope.reset();
  }
}

void DeviceSet::release() noexcept {
  for (device::Envelope& envelope : envelopes_) {
    envelope.release();
  }
}

/// Guards begin anew, so that a resumed session goes on as it would have.
void DeviceSet::engage() noexcept {
  for (std::size_t arm = 0; arm < envelopes_.size(); ++arm) {
    envelopes_[arm].engage();
    guards_[arm] = control::HandleGuard(loop_of(arms_[arm]));
    stimuli_[arm].setZero();
  }
}

void DeviceSet::go_over() noexcept {
  for (device::Envelope& envelope : envelopes_) {
    envelope.go_over();
  }
}

void DeviceSet::resume() noexcept {
  for (device::Envelope& envelope : envelopes_) {
    envelope.resume();
  }
}

/// Whether a pass may begin: not before the force of the pass before has gone from every device; a
/// fault lets it begin, to end it.
bool DeviceSet::may_begin() noexcept {
  if (fault() != Fault::kNone) {
    return true;
  }
  bool may = true;
  for (std::size_t arm = 0; arm < arms_.size(); ++arm) {
    const device::Envelope& envelope = envelopes_[arm];
    may = may && (!envelope.released() || envelope.at_rest()) && arms_[arm].device->ready();
  }
  return may;
}

Fault DeviceSet::fault() const noexcept {
  Fault found = Fault::kNone;
  for (const device::Envelope& envelope : envelopes_) {
    const Fault fault = envelope.fault();
    if (fault != Fault::kNone && (found == Fault::kNone || found == Fault::kOtherDevice)) {
      found = fault;
    }
  }
  return found;
}

std::size_t DeviceSet::faulty() const noexcept {
  for (std::size_t arm = 0; arm < envelopes_.size(); ++arm) {
    const Fault fault = envelopes_[arm].fault();
    if (fault != Fault::kNone && fault != Fault::kOtherDevice) {
      return arm;
    }
  }
  return 0;
}

}  // namespace haptrial::protocols
