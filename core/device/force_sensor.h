#pragma once

#include <Eigen/Core>

namespace haptrial::device {

/// A measured force and what is known of it.
struct MeasuredForce {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // of the device on the hand, in W [N]
  double age{0.0};                                 // since it was measured >= 0 [s]
  double time{
      0.0};  // when it was measured, by a clock that only grows; of the same one the same [s]
  double noise{0.0};  // standard deviation that its maker states; 0: not stated [N]
};

/// The latest force between a device and the hand on its handle, whatever measures it.
class ForceSensor {
 public:
  virtual ~ForceSensor() = default;
  /// @returns false if there is no measurement; `measured` is then unchanged.
  /// Servo thread: no allocation, lock, I/O or throw.
  virtual bool read(MeasuredForce& measured) noexcept = 0;
};

}  // namespace haptrial::device
