#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "analysis/contact/recording/sensor_load.h"
#include "core/base/random.h"

/// A hand that rubs and taps a plane y = 0 with a probe whose sensor has weight and offset.
namespace haptrial::test {

using namespace evaluation;

struct SimulatedContact {
  double seconds{20.0};
  double lag{0.0};          // of the force stream's clock [s]
  double pose_noise{0.0};   // each axis [m]
  double force_noise{0.0};  // each axis [N]
  double friction{0.3};
  double stiffness{1500.0};  // [N/m]
  double pose_rate{60.0}, force_rate{1000.0};
  std::uint64_t seed{1};
  SensorMount mount;
  SensorLoad load;
};

inline Eigen::Vector3d hand_path(double t) {
  const double depth = -0.001 - 0.0006 * std::sin(7.3 * t) - 0.0004 * std::sin(2.0 * t + 1.0);
  return {0.03 * std::sin(2.9 * t) + 0.01 * std::sin(0.7 * t), depth,
          0.02 * std::cos(2.3 * t + 0.5) + 0.015 * std::sin(0.9 * t)};
}

inline Eigen::Quaterniond hand_turn(double t) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::sin(1.1 * t), Eigen::Vector3d::UnitX()) *
                            Eigen::AngleAxisd(0.6 * std::sin(0.8 * t), Eigen::Vector3d::UnitZ()));
}

inline Eigen::Vector3d hand_force(double t, const SimulatedContact& s) {
  const double push = -s.stiffness * hand_path(t).y();
  Eigen::Vector3d along = hand_path(t + 1e-4) - hand_path(t - 1e-4);
  along.y() = 0.0;
  return push * (Eigen::Vector3d::UnitY() - s.friction * along.normalized());
}

inline ContactRecording simulate(const SimulatedContact& s) {
  RandomStream random(s.seed, "contact");
  const auto noise = [&random](double size) -> Eigen::Vector3d {
    const Eigen::Vector3d one(random.normal(), random.normal(), random.normal());
    return size * one;
  };
  ContactRecording recording;
  for (const double t : even_times(0.0, s.seconds, 1.0 / s.pose_rate)) {
    recording.pose.time.push_back(t);
    recording.pose.position.emplace_back(hand_path(t) + noise(s.pose_noise));
    recording.pose.orientation.push_back(hand_turn(t));
  }
  for (const double t : even_times(0.0, s.seconds, 1.0 / s.force_rate)) {
    const double at = t - s.lag;  // what the sensor felt when its clock said t
    const Eigen::Matrix3d to_sensor =
        (hand_turn(at) * s.mount.orientation).toRotationMatrix().transpose();
    const Eigen::Vector3d weight = to_sensor * s.load.weight;
    recording.force.time.push_back(t);
    recording.force.force.emplace_back(to_sensor * hand_force(at, s) + weight +
                                       s.load.force_offset + noise(s.force_noise));
  }
  return recording;
}

}  // namespace haptrial::test
