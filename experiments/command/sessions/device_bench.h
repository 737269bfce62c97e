#pragma once

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/channel/channel_options.h"
#include "core/device/device.h"
#include "core/device/envelope.h"
#include "core/device/handle_physics.h"
#include "core/device/mouse.h"
#include "core/device/vendor_devices.h"
#include "core/device/virtual_device.h"
#include "core/realtime/servo_loop.h"
#include "core/subject/hand_parameters.h"
#include "experiments/control/signals.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

/// The parts of a device's check, in their order.
enum class CheckPart : std::uint8_t { kRest, kMove, kPush, kButton, kDone };

/// Result of a check.
struct DeviceFindings {
  device::Fault fault{device::Fault::kNone};
  const char* trouble{""};                           // the device's own words for it
  double rest_noise{0.0};                            // range of position at rest, largest axis [m]
  Eigen::Vector3d lowest{Eigen::Vector3d::Zero()};   // reached while moved [m]
  Eigen::Vector3d highest{Eigen::Vector3d::Zero()};  // [m]
  double push_force{0.0};                            // of each step [N]
  Eigen::Vector3d force_axes{Eigen::Vector3d::Ones()};  // of the device (DeviceInfo)
  std::array<double, 6> yielded{};                      // along the push, +x -x +y -y +z -z [m]
  bool pushed{false};                                   // every step was made
  std::uint32_t buttons{0};                             // seen in the last part
};

/// A participant's worth of ticks against a device, behind the envelope like any protocol:
///
///     20% at rest, 40% moved about by hand, 30% small force steps, 10% a button
///
/// Servo thread: tick(). Any thread: part(). After the loop: findings().
class DeviceCheck final : public realtime::ServoTask {
 public:
  /// Stands in for the person where there is none; called before every read, on the servo thread.
  /// @param share  of the whole time, 0 to 1
  using Hand = std::function<void(CheckPart part, double share)>;

  /// @param device  outlives the check.  @param ticks  of the whole check, at least 100
  DeviceCheck(device::Device& device, const device::EnvelopeLimits& limits, std::uint64_t ticks,
              Hand hand = {});

  bool tick(const realtime::Tick& tick) noexcept override;
  /// Ends the check with a force of zero. Any thread, or a signal's handler.
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }
  /// After stop(): whether the device was given the zero.
  bool stopped() const noexcept { return stopped_.load(std::memory_order_acquire); }
  CheckPart part() const noexcept { return part_.load(std::memory_order_relaxed); }
  const DeviceFindings& findings() const noexcept { return findings_; }

  /// When a part begins, as a share of the whole time.
  static double start_of(CheckPart part) noexcept;

 private:
  Eigen::Vector3d push(double share, const Eigen::Vector3d& position) noexcept;
  void note(CheckPart part, const device::DeviceReading& reading) noexcept;

  device::Device& device_;
  device::Envelope envelope_;
  std::uint64_t ticks_;
  std::uint64_t done_{0};
  Hand hand_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> stopped_{false};
  std::atomic<CheckPart> part_{CheckPart::kRest};
  DeviceFindings findings_;
  bool has_rest_{false};
  bool has_move_{false};
  Eigen::Vector3d rest_low_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d rest_high_{Eigen::Vector3d::Zero()};
  int step_{-1};                                     // of the pushes
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};  // the push [m]
};

/// One line of a verdict.
struct Verdict {
  bool good{false};
  std::string what;  // "rate", "lateness", ...
  std::string text;  // figures, and what was expected where it is not good
};

/// @param reach  how far the tool has to have been to each side, along each axis [m]
std::vector<Verdict> judge(const DeviceFindings& findings, const realtime::ServoLoop& loop,
                           const Eigen::Vector3d& reach, bool has_button);

inline constexpr double kDeviceTestRate = 1000.0;  // [Hz]

struct DeviceTestOptions {
  std::string name;
  std::string definition;
  double seconds{120.0};
  bool read{false};  // without force, and without a verdict
  std::string library;
  std::string certificate;     // folder; empty: no certificate
  double mass{0.0};            // known, on the handle; 0: none [kg]
  bool without_sensor{false};  // of the virtual device
  std::string sensor;          // channel of the definition that measures the force; empty: none
  std::string grip_sensor;     // likewise the grip force; empty: none
  std::string sensor_axes{"x,y,z"};  // along which its axes point
  std::string loopback;              // recording of a sound's onsets; empty: none
};

/// A device, and who moves it where there is no person.
struct DeviceUnderTest {
  std::unique_ptr<device::CoupledMass> handle;  // of the virtual device
  std::unique_ptr<device::Device> device;
  DeviceCheck::Hand hand;
  Eigen::Vector3d reach;  // what counts as having tried the workspace, to each side [m]
  bool has_button{true};
};

/// How the devices are set up; a stop button is a button like any other here.
struct DeviceSetup {
  device::VirtualDeviceParameters electronics;
  subject::HandParameters hand;  // mass and friction of the virtual device's handle
  device::MouseParameters mouse;
  device::VendorSetups vendor;
  double holding_force{
      device::EnvelopeLimits{}.holding_force};      // a device may have more friction [N]
  std::vector<std::string> margins;                 // of the definition, or the published ones
  std::vector<channel::ChannelOptions> channels{};  // of the definition
  std::vector<protocols::DeviceArm> arms{};         // that the definition drives
};

/// Set-up of the definition that the options name, or that of the drivers.
/// @throws InputError for a definition that cannot be read
DeviceSetup setup_of(const DeviceTestOptions& options);

/// Opens the device to test. @throws InputError for a name that no device has, RunError if it does
/// not open
DeviceUnderTest make_bench(const DeviceTestOptions& options, const DeviceSetup& setup);

/// Takes the force away when the program is interrupted or dies.
template <class Task>
class TaskStop final : public FatalStopHandler {
 public:
  TaskStop(Task& check, device::Device& device) : check_(check), device_(device) {}
  void set_servo_thread() { servo_ = ::gettid(); }
  void ask() noexcept override { check_.stop(); }
  bool done() const noexcept override { return check_.stopped(); }
  bool on_servo_thread() const noexcept override { return servo_.load() == ::gettid(); }
  void write_zero() noexcept override { device_.write(Eigen::Vector3d::Zero()); }

 private:
  Task& check_;
  device::Device& device_;
  std::atomic<pid_t> servo_{0};
};

}  // namespace haptrial::experiments
