#pragma once

#include "analysis/contact/demo_study/duck.h"
#include "analysis/contact/recording/sensor_load.h"

namespace haptrial::evaluation {

/// A hand that leads a probe over a rigid body, and what its sensors say. Defaults are the source's
/// (§7.2): force in steps of 1/320 N at 5 kHz, pose good to 0.5 mm at 60 Hz.
struct SimulatedProbe {
  double free_seconds{4.0};         // in the air at first; three taps follow, and end it
  double seconds{30.0};             // in all
  double press{1.0};                // mean normal force [N]
  double friction{0.2};             // Coulomb
  double lag{0.0};                  // of the force's clock [s]
  double pose_rate{60.0};           // [Hz]
  double pose_noise{0.0005 / 3.0};  // each axis: 0.5 mm is three standard deviations [m]
  double force_rate{5000.0};        // [Hz]
  double force_step{1.0 / 320.0};   // [N]; 0: none
  SensorLoad load{.weight = {0.0, -0.4, 0.0},
                  .force_offset = {0.1, -0.2, 0.15},
                  .centre = Eigen::Vector3d::Zero(),
                  .torque_offset = Eigen::Vector3d::Zero()};
  Eigen::Isometry3d world_from_body{Eigen::Isometry3d::Identity()};  // T_WB
  std::uint64_t seed{1};
};

/// The force on the probe in contact is F = N (n - mu v/|v|), N changing as a hand's does. No
/// renderer and no mesh has part in it.
ContactRecording simulate_probe(const RadialBody& body, const SimulatedProbe& probe);

/// The same without sensors: where the probe is in the body's frame and the force that acts on it.
struct ProbeState {
  Eigen::Vector3d position;  // [m]
  Eigen::Vector3d force;     // [N]
};
ProbeState probe_state(const RadialBody& body, const SimulatedProbe& probe, double time);

}  // namespace haptrial::evaluation
