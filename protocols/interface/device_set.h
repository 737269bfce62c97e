#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/control/handle_guard.h"
#include "core/device/device.h"
#include "core/device/envelope.h"
#include "core/device/handle_part.h"
#include "core/stimulus/observer.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// The part of a reading that all devices have in common on a tick.
struct SessionInputs {
  std::uint32_t keys{0};               // of the participant's window
  char32_t typed{0};                   // there
  device::WindowPointer pointer{};     // over it
  std::optional<double> pedal;         // how far it is down; nothing: the session has none
  std::span<const double> channels{};  // newest values (channel::ChannelSet)
  std::span<const device::ArrivedValue> arrived{};  // all that have come since the tick before
};

/// A session drives the tips of its devices, and of those that give torque or a grip force
/// also their rotation and grip. Each is an arm, with its reading, the guard that keeps it calm,
/// and its envelope; all of them are read, limited and recorded alike (core/device/handle_part.h).
/// One for whom something is wrong stops all of them in the same tick. Servo thread, unless a
/// function says otherwise.
class DeviceSet {
 public:
  /// A part of a device that outlives the set. The arm of its tip comes before those of its
  /// rotation and grip.
  struct Arm {
    device::Device* device{nullptr};
    device::EnvelopeLimits limits;
    device::Part part{device::Part::kTip};
    double radius{1.0};                   // of the fingers about the axis of a rotation [m]
    std::optional<double> handle_mass{};  // at the fingers [kg]; else as the loop has it
  };
  /// @param arms  1 to kMostDevices, the first of them a tip
  /// @param loop  that the guard of each handle assumes
  /// @throws std::invalid_argument for another number, or as Envelope and HandleGuard do
  explicit DeviceSet(const std::vector<Arm>& arms, const control::HandleLoop& loop = {});

  std::size_t size() const noexcept { return arms_.size(); }
  device::Device& device(std::size_t arm) noexcept { return *arms_[arm].device; }

  /// Reads every device and judges what it said. @param inputs  all readings get them
  /// @param dt  since the tick before [s]
  void read(const SessionInputs& inputs, double dt) noexcept;
  Readings readings() const noexcept { return Readings(readings_); }

  /// The forces of this tick, from what a pass wants of each device.
  /// @param others  of the devices after the first; of those that it leaves out none is wanted
  void limit(const PassOutput& wanted, std::span<const Drive> others, double dt) noexcept;
  /// Zero instead, in this tick.
  void drop() noexcept;
  /// Gives each device its force; if one refuses, all are given zero. @returns whether all took it
  bool write() noexcept;
  stimulus::Forces forces() const noexcept { return stimulus::Forces(forces_); }
  bool without_force() const noexcept;

  /// The functions of Envelope, for all devices.
  /// @param trouble  about the fault, a text that lasts as long as the set; "": what a device says
  void trip(device::Fault fault, const char* trouble = "") noexcept;
  void reset() noexcept;
  void release() noexcept;
  void engage() noexcept;
  void go_over() noexcept;
  void resume() noexcept;
  bool may_begin() noexcept;
  /// Fault of a device and its number, from 0; kNone if there is none.
  device::Fault fault() const noexcept;
  std::size_t faulty() const noexcept;
  /// That device's own message when the fault began (Device::trouble()).
  const char* trouble() const noexcept { return trouble_; }

 private:
  control::HandleLoop loop_of(const Arm& arm) const;
  void read(std::size_t arm, const SessionInputs& inputs) noexcept;
  void limit(std::size_t arm, const Drive& drive, double dt) noexcept;
  std::size_t tip_of(std::size_t arm) const noexcept;
  device::Wrench wrench_of(std::size_t tip) const noexcept;
  void stop_together() noexcept;
  void note_trouble() noexcept;

  control::HandleLoop loop_;
  std::vector<Arm> arms_;
  std::vector<device::Envelope> envelopes_;
  std::vector<control::HandleGuard> guards_;
  std::vector<Eigen::Vector3d> stimuli_;  // of the last forces (ForceIntent) [N]
  std::vector<device::DeviceReading> readings_;
  std::vector<Eigen::Vector3d> forces_;  // of rotations at the fingers [N]
  const char* trouble_{""};
  bool noted_{false};  // of this fault
};

}  // namespace haptrial::protocols
