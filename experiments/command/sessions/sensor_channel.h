#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>

#include "core/channel/channel.h"
#include "core/device/force_sensor.h"

namespace haptrial::experiments {

/// A force sensor's channel, with the quantities fx, fy and fz in N, as the sensor of a
/// certificate. It reads what the device does to the sensor.
class SensorChannel final : public device::ForceSensor {
 public:
  /// Opens the instrument. @param axes  of W along which its x, y and z point: "x,-z,y"
  /// @param now  clock by which measurements have their time [ns]; none: that of the machine
  /// @throws InputError for other quantities or axes, RunError if the instrument does not answer
  SensorChannel(const channel::ChannelOptions& options, const std::string& axes,
                channel::Channel::Now now = {});

  bool read(device::MeasuredForce& measured) noexcept override;

 private:
  channel::Channel::Now now_;
  Eigen::Matrix3d to_world_;          // of the sensor's axes
  std::array<std::size_t, 3> force_;  // places of fx, fy and fz
  channel::Channel channel_;
};

/// The rotation from axes that point along these axes of W, "x,-z,y", to W.
/// @throws InputError unless they are a right-handed system
Eigen::Matrix3d rotation_of_axes(const std::string& axes);

}  // namespace haptrial::experiments
