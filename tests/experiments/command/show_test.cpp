// haptrial show: the page of an experiment, and what stands in its way.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {
namespace {

using testing::HasSubstr;

class ShowTest : public testing::Test {
 protected:
  CommandResult show(const std::string& arguments) {
    return run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
  }
  TemporaryFolder folder_;
};

TEST_F(ShowTest, WritesAPage) {
  const CommandResult result = show("show wall_detection --trial 2 --out page.html");
  EXPECT_EQ(0, result.status) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("preview: page.html"));
  EXPECT_THAT(file_text(folder_ / "page.html"), HasSubstr("Preview of wall_detection"));
}

TEST_F(ShowTest, ATrialThatIsNotThereGetsASentence) {
  const CommandResult result = show("show wall_detection --trial 100000");
  EXPECT_EQ(2, result.status);
  EXPECT_THAT(result.errors, HasSubstr("--trial is 100000; allowed: 1 to"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "wall_detection-preview.html"));
}

TEST_F(ShowTest, MistakesOfADefinitionAreNamed) {
  ASSERT_EQ(0, show("new study.toml --from wall_detection").status);
  std::string text = file_text(folder_ / "study.toml");
  text.replace(text.find("participants ="), 14, "participnts =");
  write_text(folder_ / "study.toml", text);
  const CommandResult result = show("show study.toml");
  EXPECT_EQ(2, result.status);
  EXPECT_THAT(result.errors, HasSubstr("participnts"));
  EXPECT_EQ(2, show("show wall_detection --out wall_detection.toml").status) << "no page";
}

}  // namespace
}  // namespace haptrial::test
