#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/contact/renderer.h"

namespace haptrial::contact {

/// Pose of an object: from its frame O, that of its mesh, to the world W.
struct ObjectPose {
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // of O in W, of unit length
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};               // p_WO [m]
};

/// Contact of one object with the tool on a tick, in the world frame W.
struct ObjectContact {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool; the object feels its negative [N]
  Eigen::Vector3d proxy{Eigen::Vector3d::Zero()};  // where the object feels it [m]
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  // out of the surface; zero if free
  double depth{0.0};                                // [m]
  ContactState state{ContactState::kFree};
};

/// Rigid objects in the world, felt together. Each has a proxy of its own that lives in the
/// object's frame: an object that is moved between two ticks carries its proxy along, and cannot be
/// moved through the tool's proxy, however far it moves. The forces are added. In a corner between
/// two objects whose faces are not at right angles they add to more than one proxy for both would
/// give.
class MovingObjects {
 public:
  /// Adds an object. Not on the servo thread. @returns its number: 0, 1, …
  std::size_t add(std::unique_ptr<Renderer> renderer, const ObjectPose& pose = {});
  std::size_t size() const noexcept { return objects_.size(); }

  // Servo thread, all of the following: no allocation, lock, I/O or throw.

  /// Puts the tool to a point of the world without contact.
  void start(const Eigen::Vector3d& tool) noexcept;
  /// Moves the object, or brings it in, from the next tick on. @param object  below size()
  void move(std::size_t object, const ObjectPose& pose) noexcept;
  /// One tick. @param tool  in W [m]; not finite: zero force
  /// @param period  since the tick before > 0 [s]
  /// @returns the force on the tool in W [N]
  Eigen::Vector3d tick(const Eigen::Vector3d& tool, double period) noexcept;
  /// Contact after the last tick. @param object  below size()
  const ObjectContact& contact(std::size_t object) const noexcept {
    return objects_[object].contact;
  }

 private:
  struct Object {
    std::unique_ptr<Renderer> renderer;
    ObjectPose pose;
    ObjectContact contact;
  };
  std::vector<Object> objects_;
};

}  // namespace haptrial::contact
