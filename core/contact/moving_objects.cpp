#include "core/contact/moving_objects.h"

#include <utility>

namespace haptrial::contact {

using Eigen::Vector3d;

std::size_t MovingObjects::add(std::unique_ptr<Renderer> renderer, const ObjectPose& pose) {
  objects_.push_back({std::move(renderer), pose, {}});
  return objects_.size() - 1;
}

void MovingObjects::start(const Vector3d& tool) noexcept {
  for (Object& object : objects_) {
    object.renderer->start(object.pose.orientation.conjugate() * (tool - object.pose.position));
    object.contact = {};
    object.contact.proxy = tool;
  }
}

void MovingObjects::move(std::size_t object, const ObjectPose& pose) noexcept {
  objects_[object].pose = pose;
}

Vector3d MovingObjects::tick(const Vector3d& tool, double period) noexcept {
  Vector3d force = Vector3d::Zero();
  for (Object& object : objects_) {
    const ObjectPose& pose = object.pose;
    const Contact& local =
        object.renderer->tick(pose.orientation.conjugate() * (tool - pose.position), period);
    object.contact = {pose.orientation * local.force,
                      pose.orientation * local.proxy + pose.position,
                      pose.orientation * local.normal, local.depth, local.state};
    force += object.contact.force;
  }
  return force;
}

}  // namespace haptrial::contact
