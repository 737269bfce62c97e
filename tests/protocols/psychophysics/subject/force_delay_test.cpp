// The delay of each virtual device is its own, and a part of a device has that of its tip.

#include <gtest/gtest.h>

#include <vector>

#include "core/base/definition/table.h"
#include "protocols/psychophysics/studied_definition.h"
#include "protocols/psychophysics/subject/trials_rig.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/support/felt_or_not.h"

namespace haptrial::protocols {
namespace {

/// Number of the write after which the hand has moved, under a force from the first on.
int first_moved(DeviceSet::Arm arm) {
  device::DeviceReading before;
  arm.device->read(before);
  for (int tick = 1; tick < 20; ++tick) {
    device::DeviceReading after;
    arm.device->write(device::Wrench(Eigen::Vector3d(0.0, 2.0, 0.0)));
    arm.device->read(after);
    if (after.tool.position != before.tool.position) {
      return tick;
    }
  }
  return 0;
}

TEST(ForceDelayTest, EachDeviceHasItsOwn) {
  Table root = Table::parse(
      test::felt_or_not("choices = [{ value = \"no\" }, { value = \"yes\" }]") +
          "\n[device]\nmax_force = 12.0\nworkspace_radius = 0.075\nposition_quantum = 0.0\n"
          "velocity_window = 8\nforce_delay = 2\n"
          "[devices.left]\nstart = [0, 0, 0]\nforce_delay = 5\n"
          "[devices.right]\nstart = [0, 0, 0]\n"
          "[devices.knob]\nrotation_of = \"left\"\n",
      "study.toml");
  const auto definition = trials_protocol().read(root, "study.toml", nullptr);
  const auto& d = dynamic_cast<const StudiedDefinition&>(*definition);
  EXPECT_EQ(d.force_delay(0), 5);
  EXPECT_EQ(d.force_delay(1), 2);
  EXPECT_EQ(d.force_delay(2), 5);
  SimulatedAnswer said;
  TrialsRig rig(TrialsRig::Briefing{&d, &d.observer, &d.questions, d.stages, &d.hands, &said}, 1,
                2);
  // A force acts force_delay ticks after its own, at whose end the hand has moved.
  EXPECT_EQ(first_moved({&rig.device(), {}}), 1 + 5);
  const std::vector<DeviceSet::Arm> others = rig.others();
  ASSERT_EQ(others.size(), 2u);
  EXPECT_EQ(first_moved(others[0]), 1 + 2);
  EXPECT_EQ(first_moved(others[1]), 1 + 5);
}

}  // namespace
}  // namespace haptrial::protocols
