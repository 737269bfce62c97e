#pragma once

#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/device/handle_physics.h"
#include "core/device/pointer_hand.h"
#include "core/device/virtual_device.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

struct MouseParameters {
  VirtualDeviceParameters electronics;  // as those of the virtual device
  CoupledMassParameters coupling;
  double pointer_speed{0.5};  // at which the mass is drawn after the pointer, at most > 0 [m/s]
  double max_press{12.0};     // > 0 [N]
  double first_press{2.0};    // when the left button goes down >= 0 [N]
  double press_step{0.5};     // more or less for each step of the wheel meanwhile >= 0 [N]
  int stop_button{1};         // emergency stop, the right one; -1: none
  // No keys of the table: what a protocol asks for whose hand moves in space.
  bool in_space{false};                            // reach() moves the hand, move() does not
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  // of the hand [m]
};

/// The keys of [mouse].
const Schema<MouseParameters>& mouse_schema();

/// A session on a laptop: the pointer stands for the hand. A simulated mass follows it through a
/// spring, and the protocol's forces act on that mass, so that guidance is seen but not felt. The
/// pointer gives x and z, the wheel y; a press gives the force downward (-y). If the hand moves in
/// space, it is given whole, and whoever presses against something takes it further there.
class MouseDevice final : public Device {
 public:
  /// @param rate  of the servo loop > 0 [Hz]
  /// @param name  as sessions record it, after what moves the pointer
  /// @throws std::invalid_argument naming a parameter out of its bounds.
  MouseDevice(const MouseParameters& parameters, double rate, const std::string& name = "mouse");

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;

  /// These five belong to one thread, the screen's; they never wait. What is not finite is left
  /// out, and what is out of bounds is brought to them.
  void move(double x, double z) noexcept;            // pointer [m]
  void reach(const HandPose& pose) noexcept;         // a hand in space
  void press(double force) noexcept;                 // downward; 0 where no button is held [N]
  void set_buttons(std::uint32_t buttons) noexcept;  // bit i: button i is held

  /// Steps of the wheel change the press while the left button is held, else they lift the hand by
  /// 2 mm each. @param wheel  its steps since the session's start, up > 0
  void turn_wheel(double wheel, bool pressed) noexcept;

 private:
  struct Pointer {
    HandPose hand;
    double press{0.0};  // [N]
    std::uint32_t buttons{0};
  };
  void follow() noexcept;
  Eigen::Vector3d within(const Eigen::Vector3d& point) const noexcept;

  MouseParameters parameters_;
  DeviceInfo info_;
  double period_;
  CoupledMass mass_;
  VirtualDevice electronics_;
  realtime::LatestValue<Pointer> channel_;
  Pointer asked_;                                                   // screen's thread
  double wheel_{0.0}, pressed_steps_{0.0};                          // likewise
  double height_{0.0};                                              // likewise [m]
  Pointer pointer_;                                                 // servo thread
  Eigen::Quaterniond orientation_{Eigen::Quaterniond::Identity()};  // likewise
};

}  // namespace haptrial::device
