#include "core/device/mirrored_device.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace haptrial::device::mirrored_device_test {
namespace {

using Eigen::Vector3d;

/// Gives the readings that it was told to, and keeps what it was given.
class ToldDevice final : public Device {
 public:
  explicit ToldDevice(DeviceReading& reading, Wrench& given) : reading_(reading), given_(given) {}
  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override {
    reading = reading_;
    return true;
  }
  bool write(const Wrench& wrench) noexcept override {
    given_ = wrench;
    return true;
  }

 private:
  DeviceInfo info_;
  DeviceReading& reading_;
  Wrench& given_;
};

Vector3d any_vector(RandomStream& random) {
  return {random.normal(), random.normal(), random.normal()};
}

TEST(MirroredDeviceTest, IsTheImageInAMirrorAtXZero) {
  const Eigen::Matrix3d mirror = Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  DeviceReading held;
  Wrench given;
  MirroredDevice device(std::make_unique<ToldDevice>(held, given));
  RandomStream random(1, "hands");
  for (int i = 0; i < 100; ++i) {
    held.tool = {any_vector(random), any_vector(random)};
    held.angular_velocity = any_vector(random);
    held.orientation = Eigen::AngleAxisd(2.0, any_vector(random).normalized());
    held.opening = 0.02;
    DeviceReading seen;
    ASSERT_TRUE(device.read(seen));
    EXPECT_EQ(seen.tool.position, mirror * held.tool.position);
    EXPECT_EQ(seen.tool.velocity, mirror * held.tool.velocity);
    EXPECT_TRUE(seen.orientation.toRotationMatrix().isApprox(
        mirror * held.orientation.toRotationMatrix() * mirror, 1e-12));
    EXPECT_EQ(seen.opening, held.opening);

    Wrench wanted(any_vector(random));
    wanted.torque = any_vector(random);
    wanted.grip = 1.5;
    ASSERT_TRUE(device.write(wanted));
    // No power is lost or won in a mirror.
    EXPECT_NEAR(given.force.dot(held.tool.velocity), wanted.force.dot(seen.tool.velocity), 1e-12);
    EXPECT_NEAR(given.torque.dot(held.angular_velocity), wanted.torque.dot(seen.angular_velocity),
                1e-12);
    EXPECT_EQ(given.force, mirror * wanted.force);
    EXPECT_EQ(given.grip, wanted.grip);
  }
}

}  // namespace
}  // namespace haptrial::device::mirrored_device_test
