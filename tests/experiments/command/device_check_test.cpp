// haptrial device-test: what it measures, on devices that are right and on some that are wrong.

#include "experiments/command/sessions/device_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

#include "core/device/handle_physics.h"
#include "core/device/virtual_device.h"
#include "tests/experiments/command.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/scripted_device.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;
using test::run_command;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

constexpr std::uint64_t kTicks = 4000;

device::EnvelopeLimits limits() {
  device::EnvelopeLimits l;
  l.max_force = 5.0;
  l.ramp_in = 0.0;
  return l;
}

DeviceFindings check(device::Device& device, DeviceCheck::Hand hand = {}) {
  DeviceCheck check(device, limits(), kTicks, std::move(hand));
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, 1000.0);
  loop.run(check);
  return check.findings();
}

Verdict verdict(const DeviceFindings& findings, const std::string& what, bool has_button = true) {
  const realtime::ServoLoop loop(realtime::ClockKind::kSimulated, 1000.0);
  for (const Verdict& v : judge(findings, loop, Vector3d::Constant(0.01), has_button)) {
    if (v.what == what) {
      return v;
    }
  }
  ADD_FAILURE() << "no verdict on " << what;
  return {};
}

/// A handle that a force along x moves along y: an axis is mapped wrongly.
class CrossedMass final : public device::HandlePhysics {
 public:
  PointState step(const Vector3d& f, double dt) noexcept override {
    return mass.step({f.y(), f.x(), f.z()}, dt);
  }
  PointState state() const noexcept override { return mass.state(); }
  device::CoupledMass mass{device::CoupledMassParameters{}};
};

TEST(DeviceCheckTest, EachPushIsAnsweredAsSpringAndMassSay) {
  device::CoupledMass mass({1.0, 400.0, 40.0});
  device::VirtualDeviceParameters p;
  p.position_quantum = 0.0;
  device::VirtualDevice device(p, mass, 1000.0);
  const DeviceFindings found = check(device);
  EXPECT_EQ(found.fault, device::Fault::kNone);
  EXPECT_TRUE(verdict(found, "force steps").good);
  // Critically damped, w = 20 rad/s, 1 N for 100 ms from rest; the last step of all starts 100 ms
  // after the one before it ended.
  const double wt = 20.0 * 0.1;
  EXPECT_NEAR(found.yielded[0], 1.0 / 400.0 * (1.0 - (1.0 + wt) * std::exp(-wt)), 4e-5);
  EXPECT_NEAR(found.yielded[2], found.yielded[0], 1e-5) << "+y starts from rest as +x does";
}

TEST(DeviceCheckTest, AWrongAxisIsNoticed) {
  CrossedMass mass;
  device::VirtualDevice device({}, mass, 1000.0);
  const Verdict v = verdict(check(device), "force steps");
  EXPECT_FALSE(v.good) << v.text;
}

TEST(DeviceCheckTest, AHandleThatDoesNotMoveFailsWorkspaceForceAndButton) {
  test::ScriptedDevice device;
  const DeviceFindings found = check(device);
  EXPECT_FALSE(verdict(found, "workspace").good);
  EXPECT_FALSE(verdict(found, "force steps").good);
  EXPECT_FALSE(verdict(found, "button").good);
  EXPECT_TRUE(verdict(found, "button", false).good) << "where there is none";
  double most = 0.0;
  for (const Vector3d& force : device.written) {
    most = std::max(most, force.norm());
  }
  EXPECT_DOUBLE_EQ(most, 1.0);
  EXPECT_TRUE(device.written.back().isZero(0.0));
}

TEST(DeviceCheckTest, AWorkspaceThatWasTriedAndAButtonPass) {
  test::ScriptedDevice device;
  device.on_read = [](std::size_t tick, device::DeviceReading& reading) {
    const double share = static_cast<double>(tick) / kTicks;
    reading.tool.position = 0.02 * std::sin(20.0 * std::clamp(share, 0.2, 0.6)) * Vector3d::Ones();
    reading.tool.position.x() += tick % 2 == 0 ? 0.0 : 1e-9;  // a hand is never quite still
    reading.buttons = share > 0.95 ? 2u : 0u;
    return true;
  };
  const DeviceFindings found = check(device);
  EXPECT_TRUE(verdict(found, "workspace").good) << verdict(found, "workspace").text;
  EXPECT_NEAR(found.highest.x(), 0.02, 1e-6);
  EXPECT_TRUE(verdict(found, "button").good);
}

TEST(DeviceCheckTest, AFailureEndsTheCheckWithNoForceAndItsCause) {
  test::ScriptedDevice device;
  device.on_read = [](std::size_t tick, device::DeviceReading&) { return tick < 2500; };
  const DeviceFindings found = check(device);
  EXPECT_EQ(found.fault, device::Fault::kReadFailed);
  EXPECT_THAT(verdict(found, "device").text, HasSubstr("did not answer"));
  EXPECT_LE(device.written.size(), 2502u);
  EXPECT_TRUE(device.written.back().isZero(0.0));
  EXPECT_TRUE(device.written[2500].isZero(0.0)) << "the same tick";
}

TEST(DeviceCheckTest, ATickDoesNotAllocate) {
  device::CoupledMass mass({1.0, 400.0, 40.0});
  device::VirtualDevice device({}, mass, 1000.0);
  DeviceCheck check(device, limits(), kTicks);
  const test::AllocationGuard guard;
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    check.tick({i, static_cast<std::int64_t>(i) * 1'000'000, 1e-3});
  }
  EXPECT_EQ(guard.count(), 0u);
}

/// Lines of the verdict that are not good; how well a shared machine keeps time is not the matter.
std::string failures(const std::string& output) {
  std::istringstream lines(output);
  std::string bad;
  for (std::string line; std::getline(lines, line);) {
    const bool of_time = line.starts_with("FAIL  rate") || line.starts_with("FAIL  lateness");
    bad += line.starts_with("FAIL") && !of_time ? line + "\n" : "";
  }
  return bad;
}

const std::string kLibraries = HAPTRIAL_BINARY_DIR;

TEST(TimedDeviceTest, FitDevicesPassWithFigures) {
  const std::string hand = "STAND_IN_HAND_TICKS=2000 ";
  for (const std::string& line :
       {std::string("haptrial device-test virtual --seconds 2"),
        std::string("haptrial device-test mouse --seconds 2"),
        hand + "haptrial device-test force-dimension --seconds 2 --library '" + kLibraries +
            "/libstand_in_dhd.so'",
        hand + "haptrial device-test open-haptics --seconds 2 --library '" + kLibraries +
            "/libstand_in_hd.so'"}) {
    test::CommandResult result = run_command(line);
    // A pause of 20 ms of a busy machine is a fault to a driver, and one that is longer lets the
    // hand miss its turn, rightly so: one such run is forgiven.
    if (!failures(result.output).empty()) {
      std::fprintf(stderr, "once more: %s\n%s", line.c_str(), failures(result.output).c_str());
      result = run_command(line);
    }
    EXPECT_EQ(failures(result.output), "") << line;
    EXPECT_THAT(result.output, AllOf(ContainsRegex("rate +[0-9.]+ Hz"), HasSubstr("99.9th"),
                                     ContainsRegex("(1.00|0.99) N moved")));
    const bool fit = result.output.find("FAIL") == std::string::npos;
    EXPECT_EQ(result.status, fit ? 0 : 1);
    EXPECT_THAT(result.output, HasSubstr(fit ? "is fit for use" : "is NOT fit for use"));
  }
}

TEST(DeviceTestCommandTest, AHandleThatNobodyTouchesIsNotFit) {
  const test::CommandResult result =
      run_command("haptrial device-test force-dimension --seconds 2 --library '" + kLibraries +
                  "/libstand_in_dhd.so'");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(failures(result.output), AllOf(HasSubstr("workspace"), HasSubstr("button")));
  EXPECT_THAT(result.output, HasSubstr("-> move the handle"));
}

TEST(DeviceTestCommandTest, WhatIsMissingIsNamed) {
  const test::CommandResult absent =
      run_command("haptrial device-test open-haptics --library ./libnowhere.so");
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.errors, HasSubstr("libnowhere.so"));
  const test::CommandResult unknown = run_command("haptrial device-test falcon9");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("the device to test is 'falcon9'; allowed: virtual"));
  EXPECT_THAT(unknown.errors, testing::Not(HasSubstr("gamepad"))) << "it cannot be tested";
  for (const char* line : {"gamepad", "gamepad --certificate out"}) {
    const test::CommandResult pad = run_command(std::string("haptrial device-test ") + line);
    EXPECT_EQ(pad.status, 2);
    EXPECT_THAT(pad.errors, HasSubstr("a game controller has neither test nor certificate"));
  }
  EXPECT_EQ(run_command("haptrial device-test virtual --seconds 0").status, 2);
}

TEST(DeviceTestCommandTest, DevicesListsAll) {
  const test::CommandResult result = run_command("haptrial devices");
  EXPECT_EQ(result.status, 0);
  for (const char* name :
       {"virtual", "replay", "mouse", "gamepad", "force-dimension", "open-haptics", "haply"}) {
    EXPECT_THAT(result.output, HasSubstr(name));
  }
}

}  // namespace
}  // namespace haptrial::experiments
