#pragma once

#include "core/bone/simulator/drilling_view.h"
#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/hand_model.h"

namespace haptrial::subject {

/// How a virtual participant's other hand holds the tube. Places are the device's, in W.
struct AssistingParameters {
  Eigen::Vector3d beside{0.003, 0.003, 0.0};  // the burr's tip, where the tube is held [m]
  int suck_button{0};
  int rinse_button{1};
};

/// The other hand of a virtual participant: it keeps the tube beside the burr, sucks all the time,
/// and lets water run while the burr turns. It knows what the screen shows. A rehearsal, no
/// surgeon: docs/algorithms/virtual-subject.md. Servo thread: no allocation, lock or throw.
class AssistingHand final : public stimulus::Observer {
 public:
  /// @param hand, device  of the second device; outlive this
  /// @param scale         as DrillingHand has it
  AssistingHand(const AssistingParameters& parameters, HandModel& hand,
                device::VirtualDevice& device, double scale) noexcept
      : p_(parameters), hand_(hand), device_(device), scale_(scale) {}

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

 private:
  AssistingParameters p_;
  HandModel& hand_;
  device::VirtualDevice& device_;
  double scale_;
  Eigen::Vector3d last_{Eigen::Vector3d::Zero()};  // tip of the tube
  bool known_{false};
};

}  // namespace haptrial::subject
