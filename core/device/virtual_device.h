#pragma once

#include <array>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"
#include "core/device/handle_physics.h"
#include "core/device/motor_faults.h"

namespace haptrial::device {

/// Electronics of a 3-DOF impedance device; the defaults are the published figures of the omega.3.
struct VirtualDeviceParameters {
  double max_force{12.0};          // motors saturate here > 0 [N]
  double workspace_radius{0.075};  // > 0 [m]
  double position_quantum{1e-5};   // resolution of the encoders >= 0 [m]
  int velocity_window{8};          // time of the slope that estimates velocity, 2 to 64 [ms]
  int force_delay{1};              // ticks from write() to the force, 1 to 8
  MotorFaults faults{};            // none by default
};

/// How many readings a window of velocity has: two at least.
int readings_in_window(int milliseconds, double rate) noexcept;

/// The keys of [device].
const Schema<VirtualDeviceParameters>& virtual_device_schema();

/// A device without hardware. Each write() advances the physics by one period; the force of a tick
/// acts force_delay ticks later, by default during the next one, as it does through a bus, and as
/// the planted faults of the motors say.
/// Velocity is the least-squares slope over the last readings, as drivers estimate it: over those
/// within velocity_window at any rate, and over at least two.
class VirtualDevice final : public Device {
 public:
  /// @param physics  outlives the device.
  /// @param rate     of the servo loop > 0 [Hz]
  /// @throws std::invalid_argument naming a parameter out of its bounds.
  VirtualDevice(const VirtualDeviceParameters& parameters, HandlePhysics& physics, double rate);

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;

  /// Sets buttons, pedal and orientation of the handle until the next call. Servo thread.
  /// @param pedal  0 to 1
  void hold(std::uint32_t buttons, double pedal, const Eigen::Quaterniond& orientation) noexcept {
    held_.buttons = buttons;
    held_.pedal = pedal;
    held_.orientation = orientation;
  }

 private:
  static constexpr int kMaxWindow = 1024;
  static constexpr int kMaxDelay = 8;
  void sense(const Eigen::Vector3d& position) noexcept;

  int readings_;  // in the slope

  VirtualDeviceParameters parameters_;
  DeviceInfo info_;
  HandlePhysics& physics_;
  double period_;
  FaultyMotors motors_;
  double slope_gain_;                               // of the least-squares slope [1/s]
  DeviceReading held_;                              // but for the tool itself
  std::array<Eigen::Vector3d, kMaxDelay> pending_;  // ring of forces on their way
  int oldest_{0};
  std::array<Eigen::Vector3d, kMaxWindow> history_;  // ring of readings
  int newest_{0};
};

}  // namespace haptrial::device
