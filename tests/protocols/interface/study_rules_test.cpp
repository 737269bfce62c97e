#include "protocols/interface/study_rules.h"
#include "protocols/definition/definition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/definition/table.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/experiments/shipped.h"

namespace haptrial::protocols {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> keys(const std::vector<DefinitionChange>& changes) {
  std::vector<std::string> all;
  for (const DefinitionChange& change : changes) {
    all.push_back(change.key);
  }
  return all;
}

DefinitionChanges between(const std::string& before, const std::string& after,
                          const std::string& device = "force-dimension",
                          const Protocol& protocol = force_training()) {
  record::SessionInfo first;
  first.definition = before;
  first.device = device;
  record::SessionInfo second = first;
  second.definition = after;
  return study_changes(protocol, first, second);
}

TEST(StudyRulesTest, TextsScreenDevicesAndPlansMayChange) {
  const auto changes = between(
      "[texts]\nrest = \"a\"\n[screen]\nmonitor = 0\n[design]\nparticipants = 12\n",
      "[texts]\nrest = \"b\"\n[screen]\nmonitor = 1\n[design]\nparticipants = 18\n"
      "[lab]\nuse = \"b.toml\"\n[force_dimension]\nindex = 1\nvelocity_window = 0.008\n"
      "[open_haptics]\nname = \"a\"\n[mouse]\nmax_press = 5\n[analysis]\nreference = \"visual\"\n");
  EXPECT_THAT(changes.binding, IsEmpty());
  EXPECT_THAT(keys(changes.free), ElementsAre("analysis.reference", "design.participants",
                                              "force_dimension.index", "lab.use", "mouse.max_press",
                                              "open_haptics.name", "screen.monitor", "texts.rest"));
}

TEST(StudyRulesTest, TheVirtualHandCountsIfItWasUsed) {
  const std::string before = "[hand]\nhand_mass = 0.8\n[device]\nposition_quantum = 1e-5\n";
  const std::string after = "[hand]\nhand_mass = 0.5\n[device]\nposition_quantum = 2e-5\n";
  EXPECT_TRUE(between(before, after).same_study());
  EXPECT_THAT(keys(between(before, after, "virtual").binding),
              ElementsAre("device.position_quantum", "hand.hand_mass"));
}

/// Each protocol says what only its virtual participants use; another's tables are not free.
TEST(StudyRulesTest, VirtualParticipantsCountIfOneWasAsked) {
  const std::string before = "[observer]\ncriterion = 0.4\n[subject]\nlag = 0.1\n";
  const std::string after = "[observer]\ncriterion = 0.5\n[subject]\nlag = 0.2\n";
  const std::string person = "force-dimension";
  const Protocol& trials = trials_protocol();
  EXPECT_THAT(keys(between(before, after, person, trials).binding), ElementsAre("subject.lag"));
  EXPECT_THAT(keys(between(before, after, "virtual", trials).binding),
              ElementsAre("observer.criterion", "subject.lag"));
  EXPECT_THAT(keys(between(before, after, person, force_training()).binding),
              ElementsAre("observer.criterion"));
}

/// A person's sensations follow from these keys whatever the device (compare the loop that the
/// guidance is given).
TEST(StudyRulesTest, KeysThatGuidanceReckonsWithMayNotChange) {
  const auto loop_of = [](const std::string& text) {
    return handle_loop(parse_force_definition(text, "study.toml"));
  };
  const std::string shipped = test::shipped_text();
  std::string window = shipped;
  const std::string line = "velocity_window = 0.008";
  window.replace(window.find(line), line.size(), "velocity_window = 0.016");
  EXPECT_NE(loop_of(window).velocity_window, loop_of(shipped).velocity_window);
  EXPECT_THAT(keys(between(shipped, window).binding),
              ElementsAre("force_dimension.velocity_window"));
  const std::string mass = test::shipped_with("handle_mass", "handle_mass = 0.3");
  EXPECT_NE(loop_of(mass).handle_mass, loop_of(shipped).handle_mass);
  EXPECT_THAT(keys(between(shipped, mass).binding), ElementsAre("hand.handle_mass"));
  const std::string quantum = test::shipped_with("position_quantum", "position_quantum = 2e-5");
  EXPECT_TRUE(between(shipped, quantum).same_study());
}

TEST(StudyRulesTest, WhatIsPresentedRecordedOrScoredMayNotChange) {
  for (const auto& [key, line] : {std::pair{"force_limit", "force_limit = 11.0"},
                                  {"full_scale", "full_scale = 10.0"},
                                  {"stimulus_rate", "stimulus_rate = 50.0"},
                                  {"slope_weight", "slope_weight = 0.4"},
                                  {"max_force_rate", "max_force_rate = 3000.0"}}) {
    EXPECT_FALSE(between(test::shipped_text(), test::shipped_with(key, line)).same_study()) << key;
  }
}

TEST(StudyRulesTest, AChannelMayBeWiredOtherwiseButKeepsItsUnits) {
  const std::string grip = "[channels.grip]\nkind = \"line\"\n";
  EXPECT_TRUE(between(grip + "path = \"/dev/ttyACM0\"\nquantities = { force = \"N\" }\n",
                      grip + "path = \"/dev/ttyUSB1\"\nquantities = { force = \"N\" }\n")
                  .same_study());
  EXPECT_THAT(keys(between(grip + "quantities = { force = \"N\" }\n",
                           grip + "quantities = { force = \"g\" }\n")
                       .binding),
              ElementsAre("channels.grip.quantities.force"));
  EXPECT_THAT(keys(between("[channels.a]\ninputs.grip = { input = 0, unit = \"N\" }\n",
                           "[channels.a]\ninputs.grip = { input = 2, unit = \"g\" }\n")
                       .binding),
              ElementsAre("channels.a.inputs.grip.unit"));
}

TEST(StudyRulesTest, TheOrderOfGroupsCounts) {
  EXPECT_FALSE(between("[groups]\na = 4\nb = 4", "[groups]\nb = 4\na = 4").same_study());
}

}  // namespace
}  // namespace haptrial::protocols
