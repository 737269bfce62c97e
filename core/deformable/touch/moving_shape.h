#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/deformable/body/body_motion.h"
#include "core/realtime/hand_over.h"

namespace haptrial::deformable {

/// Carries where a body's vertices are from the servo thread to one other thread, whole, for
/// pictures.
class MovingShape {
 public:
  explicit MovingShape(std::size_t vertices) {
    for (auto& slot : slots_) {
      slot.assign(vertices, Eigen::Vector3f::Zero());
    }
  }

  /// Servo thread: no allocation or lock.
  void write(const BodyMotion& motion) noexcept {
    std::vector<Eigen::Vector3f>& slot = slots_[turn_.writing()];
    for (std::size_t v = 0; v < slot.size(); ++v) {
      slot[v] = motion.position(v).cast<float>();
    }
    turn_.publish();
  }

  /// The other thread. @param places  (vertices) [m]; @returns false, leaving them alone, if
  /// nothing was written since.
  bool read(std::span<Eigen::Vector3d> places) noexcept {
    if (!turn_.take()) {
      return false;
    }
    const std::vector<Eigen::Vector3f>& slot = slots_[turn_.reading()];
    for (std::size_t v = 0; v < slot.size(); ++v) {
      places[v] = slot[v].cast<double>();
    }
    return true;
  }

 private:
  std::array<std::vector<Eigen::Vector3f>, realtime::HandOver::kSlots> slots_;
  realtime::HandOver turn_;
};

}  // namespace haptrial::deformable
