// Bounds that a later version added: no session begins beyond them, recordings beyond are read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "experiments/studies/experiment.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::recorded_bounds_test {
namespace {

using testing::HasSubstr;

/// Expects that a text is read as that of a recording, and refused as a file.
/// @returns what is said of the file
std::string refused_file(const std::string& text) {
  EXPECT_NO_THROW(parse_experiment(text, "study.toml"));
  const test::TemporaryFolder folder;
  const std::string file = (folder / "study.toml").string();
  test::write_text(file, text);
  return test::message_of([&] { load_experiment(file); });
}

TEST(RecordedBoundsTest, LongFadesCanBeReadButNotBegun) {
  EXPECT_THAT(refused_file(test::brisk_text({{"ramp_out", "ramp_out = 1.0\nchange_time = 0.3"}})),
              testing::AllOf(HasSubstr("envelope.ramp_out is 1; allowed: 0.05 to 0.5 [s]"),
                             HasSubstr("envelope.change_time is 0.3; allowed: 0.05 to 0.2 [s]")));
}

TEST(RecordedBoundsTest, ChannelsOnOneLineCanBeReadButNotBegun) {
  const std::string line = "kind = \"line\"\npath = \"/dev/ttyACM0\"\nquantities = { x = \"m\" }\n";
  EXPECT_THAT(
      refused_file(test::brisk_text() + "\n[channels.a]\n" + line + "[channels.b]\n" + line),
      HasSubstr("channels.b.path is \"/dev/ttyACM0\", as that of channel a"));
}

TEST(RecordedBoundsTest, LevelsThatAFileHasNoRoomForCanBeReadButNotBegun) {
  const std::string shipped =
      test::read_text(test::shipped_definition().parent_path() / "stiffness_discrimination.toml");
  EXPECT_THAT(refused_file(shipped + "\n[factors]\ntool = [\"" + std::string(65, 'x') +
                           "\", \"needle\"]\n"),
              HasSubstr("allowed: words of at most 64 bytes"));
}

TEST(RecordedBoundsTest, UnknownPlaceholdersCanBeReadButNotBegun) {
  const std::string shipped =
      test::read_text(test::shipped_definition().parent_path() / "first_drilling.toml");
  EXPECT_THAT(refused_file(shipped + "\n[hints]\nkinds = [\"hidden\"]\n"
                                     "hidden_text = \"{struktur}\"\n"),
              HasSubstr("study.toml: hints.hidden_text has {struktur}, which stands for nothing; "
                        "allowed: {structure}"));
}

TEST(RecordedBoundsTest, APowerPlanOfVersion02CanBeReadButNotAsked) {
  const std::string said = refused_file(test::brisk_text() +
                                        "\n[power]\nwatch = \"a\"\nrobust = true\n"
                                        "[[power.vary]]\nkey = \"design.participants\"\n"
                                        "values = [4, 8]\n");
  EXPECT_THAT(said, HasSubstr("power.robust is a key of version 0.2 alone"));
}

}  // namespace
}  // namespace haptrial::experiments::recorded_bounds_test
