#include "analysis/contact/demo_study/simulated_probe.h"

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kTap = 0.5;  // from tap to tap [s]
constexpr int kTaps = 3;
constexpr double kGap = 0.008;      // of a probe in the air [m]
constexpr double kSlowest = 0.001;  // friction turns round over this speed [m/s]
constexpr double kHalfStep = 1e-4;  // for velocities [s]

/// Direction of the hand over the body: strokes over its back, head and sides.
Vector3d direction_at(double t) {
  const double along = 0.95 * std::sin(2.9 * t) + 0.25 * std::sin(0.61 * t + 1.0);
  const double across = 0.75 * std::sin(2.17 * t + 0.5) + 0.15 * std::sin(5.3 * t);
  return Vector3d(std::sin(along), std::cos(along) * std::cos(across),
                  std::cos(along) * std::sin(across));
}

/// Height over the surface and normal force: one of them is 0.
struct Press {
  double gap, force;
};
Press press_at(const SimulatedProbe& p, double t) {
  const double taps = kTaps * kTap;
  const double since = t - p.free_seconds, left = p.seconds - t;
  if (since < 0.0) {
    return {kGap * std::min(1.0, -since / kTap), 0.0};
  }
  if (since < taps || left < taps) {
    const double phase = since < taps ? since : taps - left;
    const double wave = std::sin(2.0 * std::numbers::pi * phase / kTap);
    return wave > 0.0 ? Press{0.0, 2.0 * p.press * wave} : Press{-kGap * wave, 0.0};
  }
  const double ease = std::min({1.0, (since - taps) / kTap, (left - taps) / kTap});
  return {0.0, ease * p.press * (1.0 + 0.35 * std::sin(3.1 * t) + 0.15 * std::sin(11.7 * t))};
}

Vector3d position_at(const RadialBody& body, const SimulatedProbe& p, double t) {
  const Vector3d d = direction_at(t);
  return (body(d) + press_at(p, t).gap) * d;
}

Eigen::Quaterniond turn_at(double t) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.7 * std::sin(2.3 * t), Vector3d::UnitX()) *
                            Eigen::AngleAxisd(0.8 * std::sin(1.7 * t + 0.3), Vector3d::UnitZ()));
}

double rounded(double x, double step) { return step > 0.0 ? step * std::round(x / step) : x; }

}  // namespace

ProbeState probe_state(const RadialBody& body, const SimulatedProbe& probe, double time) {
  const Vector3d normal = radial_normal(body, direction_at(time));
  const Vector3d way =
      position_at(body, probe, time + kHalfStep) - position_at(body, probe, time - kHalfStep);
  const Vector3d velocity = (way - way.dot(normal) * normal) / (2.0 * kHalfStep);
  const Vector3d drag = velocity / std::hypot(velocity.norm(), kSlowest);
  return {position_at(body, probe, time),
          press_at(probe, time).force * (normal - probe.friction * drag)};
}

ContactRecording simulate_probe(const RadialBody& body, const SimulatedProbe& probe) {
  RandomStream random(probe.seed, "probe");
  ContactRecording recording;
  for (const double t : even_times(0.0, probe.seconds, 1.0 / probe.pose_rate)) {
    const Vector3d noise(random.normal(), random.normal(), random.normal());
    recording.pose.time.push_back(t);
    recording.pose.position.emplace_back(probe.world_from_body * position_at(body, probe, t) +
                                         probe.pose_noise * noise);
    recording.pose.orientation.push_back(turn_at(t));
  }
  for (const double t : even_times(0.0, probe.seconds, 1.0 / probe.force_rate)) {
    const double felt = t - probe.lag;  // when the sensor felt what its clock says at t
    const Vector3d force = probe.world_from_body.linear() * probe_state(body, probe, felt).force;
    Vector3d said =
        turn_at(felt).conjugate() * (force + probe.load.weight) + probe.load.force_offset;
    for (double& component : said) {
      component = rounded(component, probe.force_step);
    }
    recording.force.time.push_back(t);
    recording.force.force.push_back(said);
  }
  return recording;
}

}  // namespace haptrial::evaluation
