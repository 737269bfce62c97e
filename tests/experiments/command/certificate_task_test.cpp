#include "experiments/command/sessions/certificate_task.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "analysis/device/excitation.h"
#include "tests/support/scripted_device.h"

namespace haptrial::experiments {
namespace {

using analysis::CertificatePart;

/// A handle that swings 10 mm about the place beyond which it is caught, at up to 0.5 m/s.
bool swing_about_the_edge(std::size_t tick, device::DeviceReading& reading) {
  constexpr double kEdge = 0.8 * 0.075, kDepth = 0.01;     // [m]
  constexpr double kOmega = 2.0 * std::numbers::pi * 8.0;  // [1/s]
  const double phase = 1e-3 * kOmega * static_cast<double>(tick);
  reading.tool.position.y() = -kEdge + kDepth * std::sin(phase);
  reading.tool.velocity.y() = kDepth * kOmega * std::cos(phase);
  return true;
}

/// The axis is caught first, then driven, then caught again. The tones of the excitation alone make
/// steps of up to 0.33 N.
TEST(CertificateTaskTest, AFreeHandleIsHeldWithoutASteppingForce) {
  test::ScriptedDevice device;
  device.on_read = swing_about_the_edge;
  const analysis::Excitation excitation(1000.0, 4.8);
  CertificateTask task(device, nullptr, excitation, {CertificatePart::kFree},
                       [](CertificatePart, long) {});
  const auto ticks = static_cast<std::size_t>(excitation.ticks(CertificatePart::kFree));
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    task.tick({tick, static_cast<std::int64_t>(1000000 * tick), 1e-3});
  }
  EXPECT_EQ(task.fault(), device::Fault::kNone);
  double step = 0.0, largest = 0.0;
  for (std::size_t tick = 1; tick < ticks; ++tick) {
    const double force = device.written[tick].y();
    step = std::max(step, std::abs(force - device.written[tick - 1].y()));
    largest = std::max(largest, force);
  }
  EXPECT_LT(step, 0.5);
  EXPECT_GT(largest, 0.8) << "80 N/m at 10 mm";
}

}  // namespace
}  // namespace haptrial::experiments
