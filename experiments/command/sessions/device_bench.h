#pragma once

#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "core/channel/channel_options.h"
#include "core/device/coupled_mass.h"
#include "core/device/mouse.h"
#include "core/device/vendor_devices.h"
#include "core/device/virtual_device.h"
#include "core/subject/hand_parameters.h"
#include "experiments/command/sessions/device_check.h"
#include "experiments/control/fatal_stop_handler.h"
#include "protocols/definition/device_arm.h"

namespace haptrial::experiments {

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
