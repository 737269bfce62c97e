#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "core/stimulus/shown.h"

namespace haptrial::stimulus {

/// Forces that the devices of a session apply to the hands, in their order, in W [N].
class Forces {
 public:
  Forces(const Eigen::Vector3d& only) noexcept : all_(&only, 1) {}  // implicit: of one device
  explicit Forces(std::span<const Eigen::Vector3d> all) noexcept : all_(all) {}
  const Eigen::Vector3d& operator[](std::size_t device) const noexcept { return all_[device]; }
  std::size_t size() const noexcept { return all_.size(); }

 private:
  std::span<const Eigen::Vector3d> all_;
};

/// Somebody to whom a pass is presented, tick by tick: a virtual subject, or the screen.
class Observer {
 public:
  virtual ~Observer() = default;
  /// @param shown  what is to be seen at this tick
  /// @param dt     since the previous tick [s]
  /// Servo thread: no allocation, lock, I/O or throw.
  virtual void observe(const Shown& shown, const Forces& forces, double dt) noexcept = 0;
};

}  // namespace haptrial::stimulus
