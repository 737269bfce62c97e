#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "core/base/point_state.h"
#include "core/control/gain_shares.h"

namespace haptrial::device {

/// The parts of a handle that the loop reads and drives, each by the same laws and under the same
/// watch: its tip, its rotation, and the opening of its gripper.
enum class Part : std::uint8_t { kTip, kRotation, kGrip };

/// A value of a channel that has come since the tick before.
struct ArrivedValue {
  std::size_t place{0};  // of its quantity among the newest values
  double value{0.0};
  double age{0.0};  // since it was measured [s]
};

/// Abilities of a device, for the session file and for checks before a session.
struct DeviceInfo {
  std::string name;
  double max_force{12.0};          // sustained [N]
  double workspace_radius{0.075};  // about the origin [m]
  bool simulated{false};           // no hardware and no person behind it
  bool senses_orientation{false};  // else every reading has the identity
  /// 1 along each axis of W along which it moves and gives forces, 0 along the others; forces along
  /// these are left out before they are limited and recorded.
  Eigen::Vector3d force_axes{Eigen::Vector3d::Ones()};
  /// 1 along each axis of W about which it gives torque, 0 along the others: none by default.
  Eigen::Vector3d torque_axes{Eigen::Vector3d::Zero()};
  double max_torque{0.0};      // sustained [N·m]
  double max_grip_force{0.0};  // of its gripper, which it has if this is above 0 [N]
};

/// Forces of a handle on the hand, in W. A device gives those that its DeviceInfo names.
struct Wrench {
  Wrench() = default;
  template <class Vector>
  Wrench(const Eigen::MatrixBase<Vector>& only) : force(only) {}  // implicit: a force alone

  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // on the tool tip [N]
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // about the tool tip [N·m]
  double grip{0.0};                                 // that opens the fingers [N]
};

/// The pointer of the participant's window.
struct WindowPointer {
  double x{std::numeric_limits<double>::quiet_NaN()};  // in W; NaN: it was not over the window [m]
  std::uint32_t buttons{0};                            // bit 0 left, 1 right, 2 middle
};

/// One reading of a device, in the world frame W (docs/conventions.md).
struct DeviceReading {
  PointState tool;           // tool tip
  std::uint32_t buttons{0};  // bit i: button i is pressed
  bool forces_on{true};      // false: the device has switched its motors off
  bool stop_pressed{false};  // the button that the device's set-up names as emergency stop
  /// Rotation from the handle's own frame to W, unit length; identity if the device does not sense
  /// it. Which way the handle runs in its frame is a parameter of what is held.
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};
  std::uint32_t keys{0};  // bit i: function i of the definition is held by a key of the window
  char32_t typed{0};      // character that was typed in the window since the last reading; 0: none
  WindowPointer pointer{};
  double pedal{0.0};  // how far an analog pedal is down, 0 to 1
  /// Newest values of the session's channels (channel::place_of); NaN: none. Valid for the tick.
  std::span<const double> channels{};
  std::span<const ArrivedValue> arrived{};  // values of channels; also valid for the tick
  control::GainShares shares{};  // of the gains of all laws, which the handle carries now
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  // in W [rad/s]
  double opening{0.0};        // between the fingers of the gripper [m]
  double opening_speed{0.0};  // [m/s]
};

/// Whether a button is among those pressed. @param button  from 0; below 0 there is none
constexpr bool is_pressed(std::uint32_t buttons, int button) noexcept {
  return button >= 0 && ((buttons >> static_cast<unsigned>(button)) & 1u) != 0;
}

/// An impedance device: the pose is read, the wrench is commanded.
/// Opened by its constructor, which throws; read() and write() belong to the servo thread and never
/// throw, allocate or lock.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceInfo& info() const noexcept = 0;
  /// @returns false when the device did not answer; `reading` is then unchanged.
  virtual bool read(DeviceReading& reading) noexcept = 0;
  /// @returns false when the device refused it.
  virtual bool write(const Wrench& wrench) noexcept = 0;
  /// Whether a pass may begin with the next read(); asked before it on every tick while a pass
  /// wants to begin. A recording lets each pass begin where it began when it was recorded. Servo
  /// thread.
  virtual bool ready() noexcept { return true; }
  /// Why the last read or write failed or the motors went off, in a sentence; "" where all is well.
  /// A text of static duration. The thread that reads.
  virtual const char* trouble() const noexcept { return ""; }
  /// Calls into the device's library that took longer than a period of the loop. Any thread.
  virtual std::uint64_t slow_calls() const noexcept { return 0; }
};

}  // namespace haptrial::device
