#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>

#include "core/channel/channel.h"
#include "core/device/force_sensor.h"
#include "core/device/handle_part.h"

namespace haptrial::experiments {

/// A force sensor's channel as the sensor of a certificate: its quantities fx, fy and fz in N for a
/// tip, tx, ty and tz in N·m for a rotation, `grip` in N for a grip, which opens the fingers. It
/// reads what the device does to the sensor, of a rotation at the fingers.
class SensorChannel final : public device::ForceSensor {
 public:
  /// Opens the instrument. @param axes  of W along which its x, y and z point: "x,-z,y"
  /// @param radius  of the fingers about the axis of a rotation [m]
  /// @param now  clock by which measurements have their time [ns]; none: that of the machine
  /// @throws InputError for other quantities or axes, RunError if the instrument does not answer
  SensorChannel(const channel::ChannelOptions& options, const std::string& axes,
                channel::Channel::Now now = {}, device::Part of = device::Part::kTip,
                double radius = 1.0);

  bool read(device::MeasuredForce& measured) noexcept override;

 private:
  channel::Channel::Now now_;
  Eigen::Matrix3d to_world_;          // of the sensor's axes
  std::array<std::size_t, 3> force_;  // places of its quantities
  bool is_grip_;
  double newton_;  // of 1 N at the fingers [N or N·m]
  channel::Channel channel_;
};

/// Whether a channel has the quantities of this part's sensor.
bool measures(const channel::ChannelOptions& options, device::Part part);

/// The rotation from axes that point along these axes of W, "x,-z,y", to W.
/// @throws InputError unless they are a right-handed system
Eigen::Matrix3d rotation_of_axes(const std::string& axes);

}  // namespace haptrial::experiments
