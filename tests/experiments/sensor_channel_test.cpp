// A force sensor's channel as the sensor of a certificate.

#include "experiments/command/sessions/sensor_channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/experiments/command.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_rdt.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

channel::ChannelOptions sensor_at(int port) {
  Table root = Table::parse(
      fmt::format("[channels.force]\nkind = \"rdt\"\nhost = \"127.0.0.1\"\nport = {}\n"
                  "counts_per_force = 1000.0\ncounts_per_torque = 1000.0\nrate = 1000.0\n",
                  port),
      "lab.toml");
  const std::vector<channel::ChannelOptions> channels = channel::read_channels(root);
  root.finish();
  return channels.front();
}

TEST(SensorChannelTest, AForceIsTurnedToTheWorldAndHasAnAge) {
  test::StandInRdt stand_in;
  SensorChannel sensor(sensor_at(stand_in.port()), "x,-z,y");
  device::MeasuredForce measured;
  std::uint32_t sequence = 2;
  const auto arrives = [&] {
    stand_in.send({sequence++, 0, {1000, 2000, 3000, 0, 0, 0}});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return sensor.read(measured) && measured.force.x() == 1.0;
  };
  while (!arrives()) {
  }
  // Its y points along -z of the world, its z along y.
  EXPECT_LT((measured.force - Vector3d(1.0, 3.0, -2.0)).norm(), 1e-12);
  EXPECT_GE(measured.age, 0.0);
  EXPECT_LT(measured.age, 10.0);
}

TEST(SensorChannelTest, AxesThatAreNoRotationAreRefused) {
  EXPECT_EQ(rotation_of_axes("x,y,z"), Eigen::Matrix3d::Identity());
  EXPECT_EQ(rotation_of_axes("-x,-y,z") * Vector3d(1.0, 2.0, 3.0), Vector3d(-1.0, -2.0, 3.0));
  for (const char* wrong : {"", "x,y", "x,y,-z", "x,x,y", "x,y,w", "x,y,z,x"}) {
    EXPECT_THAT(test::message_of([&] { rotation_of_axes(wrong); }), HasSubstr("--sensor-axes is"))
        << wrong;
  }
}

TEST(SensorChannelTest, WhatIsNoForceSensorIsRefused) {
  test::StandInRdt stand_in;
  channel::ChannelOptions options = sensor_at(stand_in.port());
  options.plan.quantities[1].unit = "lbf";
  EXPECT_THAT(
      test::message_of([&] { SensorChannel(options, "x,y,z"); }),
      HasSubstr("channels.force: a force sensor of a tip has the quantities fx, fy and fz in N; fy"));
}

TEST(SensorChannelTest, TheCommandSaysWhichChannelIsMissing) {
  const auto result = test::run_command(
      "haptrial device-test force-dimension --certificate nowhere --sensor force");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--sensor force needs --definition FILE with a table "
                                       "[channels.force]"));
  const auto of_virtual =
      test::run_command("haptrial device-test virtual --certificate nowhere --sensor force");
  EXPECT_EQ(of_virtual.status, 2);
  EXPECT_THAT(of_virtual.errors, HasSubstr("the virtual device has simulated sensors"));
}

}  // namespace
}  // namespace haptrial::experiments
