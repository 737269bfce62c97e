#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/device/virtual_device.h"
#include "core/scene/scene.h"
#include "core/subject/hand.h"
#include "core/subject/perceiver/probing.h"

namespace haptrial::test {}

namespace haptrial::subject::test {

using namespace haptrial::test;  // helpers of all tests, beside those of this folder

using Eigen::Vector3d;

inline constexpr double kStep = 1e-3;  // [s]

inline scene::Field field(std::string name, scene::FieldKind kind, double limit = 20.0) {
  return {std::move(name), std::move(kind), limit, 0.0, 0.0};
}

/// A floor below y = 0.
inline scene::Field floor_of(double stiffness, double damping = 2.0) {
  return field("floor", scene::SurfaceParameters{scene::HalfSpace{}, false, {stiffness, damping}});
}

/// A hand on the virtual device in a scene, and the arm that probes: a servo loop of 1 kHz without
/// a clock.
class HandRig {
 public:
  /// Callback for a tick: the time since the probe began, the force on the hand, its reading.
  using Tick = std::function<void(double, const Vector3d&, const PointState&)>;

  explicit HandRig(const std::vector<scene::Field>& fields = {},
                   const Vector3d& start = Vector3d::Zero(), const HandParameters& parameters = {})
      : hand(parameters, kStep, start),
        device(device::VirtualDeviceParameters{}, hand, 1.0 / kStep),
        scene(fields, 1.0 / kStep),
        prober(parameters) {
    scene.switch_to(scene::Scene::kAll);
  }

  PointState read() {
    device::DeviceReading reading;
    device.read(reading);
    return reading.tool;
  }

  void run(const Probe& probe, double seconds, const Tick& tick = {}) {
    prober.begin(probe, read());
    go_on(seconds, tick);
  }

  void go_on(double seconds, const Tick& tick = {}) {
    for (int i = 0; i < static_cast<int>(seconds / kStep + 0.5); ++i) {
      const PointState tool = read();
      const Vector3d force = scene.force(tool);
      HandCommand command = prober.command(tool, kStep, force);
      command.force += extra;
      hand.command(command);
      if (tick) {
        tick(prober.time(), force, tool);
      }
      device.write(force);
    }
  }

  Hand hand;
  device::VirtualDevice device;
  scene::Scene scene;
  ExplorationController prober;
  Vector3d extra{Vector3d::Zero()};  // of the arm, beside the probe's command [N]
};

}  // namespace haptrial::subject::test
