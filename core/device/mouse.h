#pragma once

#include "core/device/coupled_mass.h"
#include "core/device/virtual_device.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

struct MouseParameters {
  VirtualDeviceParameters electronics;  // as those of the virtual device
  CoupledMassParameters coupling;
  double pointer_speed{0.5};  // at which the mass is drawn after the pointer, at most > 0 [m/s]
  double max_press{12.0};     // > 0 [N]
};

/// A session on a laptop: the pointer stands for the hand. A simulated mass follows it through a
/// spring, and the protocol's forces act on that mass, so that guidance is seen but not felt. The
/// pointer gives x and z; a press gives the force downward (-y).
class MouseDevice final : public Device {
 public:
  /// @param rate  of the servo loop > 0 [Hz]
  /// @throws std::invalid_argument naming a parameter out of its bounds.
  MouseDevice(const MouseParameters& parameters, double rate);

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Eigen::Vector3d& force) noexcept override;

  /// These three belong to one thread, the screen's; they never wait. What is not finite is left
  /// out, and what is out of bounds is brought to them.
  void move(double x, double z) noexcept;            // pointer [m]
  void press(double force) noexcept;                 // downward; 0 where no button is held [N]
  void set_buttons(std::uint32_t buttons) noexcept;  // bit i: button i is held

 private:
  struct Pointer {
    double x{0.0};      // [m]
    double z{0.0};      // [m]
    double press{0.0};  // [N]
    std::uint32_t buttons{0};
  };
  void follow() noexcept;

  MouseParameters parameters_;
  DeviceInfo info_;
  double period_;
  CoupledMass mass_;
  VirtualDevice electronics_;
  realtime::LatestValue<Pointer> channel_;
  Pointer asked_;    // screen's thread
  Pointer pointer_;  // servo thread
};

}  // namespace haptrial::device
