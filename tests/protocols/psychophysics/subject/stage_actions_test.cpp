#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/psychophysics/definition/trial_devices.h"
#include "protocols/psychophysics/subject/stage_actions.h"
#include "protocols/psychophysics/subject/trials_rig.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/support/felt_or_not.h"

namespace haptrial::protocols::stage_actions_test {
namespace {

using testing::HasSubstr;

/// @returns number of actions that were read, and the sentences about mistakes.
std::pair<std::size_t, std::string> read(const std::string& ready,
                                         const std::vector<TrialDevice>& devices) {
  Table root = Table::parse("[actions]\nready = " + ready + "\n", "actions.toml");
  Table actions = root.table("actions");
  const std::size_t count = read_actions(actions, {"ready"}, devices).size();
  try {
    root.finish();
  } catch (const InputError& error) {
    return {count, error.what()};
  }
  return {count, ""};
}

TEST(StageActionsTest, AnActionHoldsForOneHandForAllOrForThoseThatAreNamed) {
  TrialDevice finger;
  finger.name = "finger";
  TrialDevice thumb;
  thumb.name = "thumb";
  using Read = std::pair<std::size_t, std::string>;
  EXPECT_EQ(read("{ do = \"hold\" }", {}), Read(1, ""));
  EXPECT_EQ(read("{ do = \"hold\" }", {finger, thumb}), Read(2, ""));
  EXPECT_EQ(read("{ thumb = { do = \"hold\" } }", {finger, thumb}), Read(1, ""));
}

TEST(StageActionsTest, AnActionOfNobodyIsRefused) {
  TrialDevice finger;
  finger.name = "finger";
  EXPECT_THAT(read("{}", {}).second, HasSubstr("actions.ready.do is missing"));
  EXPECT_THAT(read("{}", {finger}).second, HasSubstr("actions.ready.do is missing"));
  EXPECT_THAT(read("{ fingr = { do = \"hold\" } }", {finger}).second,
              HasSubstr("did you mean finger?"));
}

}  // namespace

// The delay of each virtual device is its own, and a part of a device has that of its tip.

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
}  // namespace haptrial::protocols::stage_actions_test
