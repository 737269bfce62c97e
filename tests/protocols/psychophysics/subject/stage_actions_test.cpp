#include "protocols/psychophysics/subject/stage_actions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/psychophysics/definition/trial_devices.h"

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
}  // namespace haptrial::protocols::stage_actions_test
