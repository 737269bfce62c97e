// Buttons that two keys of a drilling use: validate and run say so.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/definition/button_uses.h"
#include "tests/experiments/command.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Lines = std::vector<std::pair<std::string, std::string>>;

std::vector<std::string> warnings(const Lines& lines,
                                  const std::vector<std::string>& devices = {}) {
  return protocols::button_warnings(
      protocols::parse_bone_definition(test::drilling_with(lines), "study.toml"), devices);
}

TEST(DrillingButtonsTest, TwoFunctionsOfOneButtonAreNamed) {
  EXPECT_THAT(warnings({}), IsEmpty());
  EXPECT_THAT(warnings({{"previous_tool", "previous_tool = [2, 1]"}}),
              ElementsAre("buttons.next_tool and buttons.previous_tool both take button 1, so that "
                          "one press does both; give one of them another button"));
}

TEST(DrillingButtonsTest, AStopButtonThatTakesAToolIsNamed) {
  EXPECT_THAT(warnings({}, {"haply"}),
              ElementsAre("haply.stop_button is 2 by default, and buttons.previous_tool "
                          "takes button 2, too, so that who presses it stops the session; give one "
                          "of them another button"));
  EXPECT_THAT(warnings({}, {"force-dimension"}), IsEmpty());  // -1
  EXPECT_THAT(
      warnings({{"stop_button", "stop_button = 2"}}),
      ElementsAre(HasSubstr("force_dimension.stop_button is 2, and buttons.previous_tool")));
}

TEST(DrillingButtonsTest, ValidateAndRunSayIt) {
  const test::TemporaryFolder folder;
  const auto study =
      test::write_small_drilling(folder.path(), 5.0, {{"stop_button", "stop_button = 2"}});
  const std::string sentence =
      "warning: force_dimension.stop_button is 2, and buttons.previous_tool takes button 2, too";
  const auto validated =
      test::run_command(fmt::format("haptrial validate '{}/study.toml'", folder.path().string()));
  EXPECT_EQ(validated.status, 0) << validated.errors;
  EXPECT_THAT(validated.output, HasSubstr(sentence));
  const auto run = test::run_command(
      fmt::format("haptrial run '{0}/study.toml' --subject P01 --device haply --out '{0}/out'",
                  folder.path().string()));
  EXPECT_NE(run.status, 0);  // there is no such device here
  EXPECT_THAT(run.output, HasSubstr("warning: haply.stop_button is 2 by default, and "
                                    "buttons.previous_tool takes button 2, too"));
}

}  // namespace
}  // namespace haptrial::experiments
