// First commands of a newcomer: examples, new, doctor.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "experiments/command/start/examples.h"
#include "experiments/command/start/machine_checks.h"
#include "experiments/studies/experiment.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using test::run_command;
using testing::HasSubstr;

TEST(ExamplesTest, AreTheShippedDefinitions) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".toml") && name.find(".texts.") == std::string::npos) {
      ++files;
      EXPECT_EQ(example_named(entry.path().stem().string()).text, test::read_text(entry.path()));
    }
  }
  EXPECT_EQ(examples().size(), files);
}

/// A copy differs from its example in its name and in nothing else that is read.
TEST(ExamplesTest, UnderAnotherNameEachIsADefinition) {
  for (const Example& example : examples()) {
    const std::string text = renamed(example, "mine");
    EXPECT_EQ(text.size() + example.name.size(), example.text.size() + 4) << example.name;
    EXPECT_EQ(parse_experiment(text, "mine.toml").definition->name, "mine") << example.name;
    EXPECT_FALSE(what_of(example).empty()) << example.name;
  }
  EXPECT_EQ(what_of(example_named("wall_detection")),
            "Detection of a virtual wall: was there anything?");
}

TEST(StartTest, ANewDefinitionIsReadyToRehearse) {
  const test::TemporaryFolder folder;
  const std::string in_folder = "cd '" + folder.path().string() + "'; ";
  const auto made = run_command(in_folder + "haptrial new mine --from wall_detection");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("haptrial dry-run mine.toml --subjects 2"));
  const auto dry = run_command(in_folder + "haptrial dry-run mine.toml --subjects 1 --trials 2");
  EXPECT_EQ(dry.status, 0) << dry.errors;
  EXPECT_TRUE(fs::exists(folder / "out/mine-001/S01.h5"));

  const auto refused = [&](const std::string& line, const std::string& sentence) {
    const auto result = run_command(in_folder + line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << line;
  };
  refused("haptrial new mine.toml", "mine.toml: exists already");
  refused("haptrial new other --from wall_detecton", "did you mean wall_detection?");
  refused("haptrial new other --from stifness", "did you mean stiffness_discrimination?");
  refused("haptrial new 'two words'", "FILE is 'two words', whose name is to be that of the study");
  refused("haptrial new mine.txt", "allowed: a name that ends in .toml");
  EXPECT_FALSE(fs::exists(folder / "other.toml"));
}

TEST(StartTest, AShippedDefinitionIsNamedWithoutAFile) {
  const test::TemporaryFolder folder;
  const std::string in_folder = "cd '" + folder.path().string() + "'; ";
  const auto valid = run_command(in_folder + "haptrial validate wall_detection");
  ASSERT_EQ(valid.status, 0) << valid.errors;
  EXPECT_THAT(valid.output, HasSubstr("wall_detection.toml: a copy of the shipped definition"));
  EXPECT_THAT(valid.output, HasSubstr("wall_detection.toml: valid"));
  EXPECT_EQ(test::read_text(folder / "wall_detection.toml"), example_named("wall_detection").text);
  test::write_text(folder / "wall_detection.toml", "[experiment]\nprotocol = \"none\"\n");
  EXPECT_EQ(run_command(in_folder + "haptrial validate wall_detection").status, 2)
      << "the copy is the user's";
  const auto path = run_command(in_folder + "haptrial validate experiments/force_training.toml");
  EXPECT_EQ(path.status, 2);
  EXPECT_THAT(path.errors, HasSubstr("force_training is a shipped definition"));
}

TEST(StartTest, AFileOfTextsHasEveryTextToBeTranslated) {
  const test::TemporaryFolder folder;
  const std::string in_folder = "cd '" + folder.path().string() + "'; ";
  std::string text(example_named("first_experiment").text);
  text.replace(text.find("\"yes\""), 5, "\"oh yes\"");  // a key of two words
  test::write_text(folder / "study.toml",
                   text + "[texts]\nrest = \"\"\"\nSay \\\"Ja\\\"\nä \\\\ b\"\"\"\n");
  const auto made = run_command(in_folder + "haptrial texts study.toml --language ja");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(run_command(in_folder + "haptrial validate study.toml").output,
              HasSubstr("language ja: incomplete"))
      << "what keeps its mark is not translated";
  const fs::path file = folder / "study.texts.ja.toml";
  EXPECT_THAT(test::read_text(file),
              HasSubstr("# response.choices.\"oh yes\".label = \"oh yes\"\n"));
  ASSERT_EQ(
      run_command(in_folder + "sed -i 's/^# \\([a-z][a-z0-9_.\" ]* = \\)/\\1/' " + file.string())
          .status,
      0);
  const auto valid = run_command(in_folder + "haptrial validate study.toml");
  EXPECT_THAT(valid.output, HasSubstr("language ja: complete")) << valid.output << valid.errors;
  const auto again = run_command(in_folder + "haptrial texts study.toml --language ja");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("study.texts.ja.toml: exists already"));
  EXPECT_EQ(run_command(in_folder + "haptrial texts study.toml --language ../x").status, 2);
}

TEST(StartTest, TheDoctorSaysWhatSessionsCanUse) {
  const test::TemporaryFolder folder;
  const auto found = run_command("haptrial doctor '" + folder.path().string() + "'");
  EXPECT_EQ(found.status, 0) << found.output;
  for (const char* what : {"clock", "real time", "pictures", "window", "sound", "disk", "mouse"}) {
    EXPECT_THAT("\n" + found.output, HasSubstr(std::string("\n") + what)) << what;
  }
  const std::size_t absent = found.output.find("  absent ");
  ASSERT_NE(absent, std::string::npos) << "no robot is connected here";
  EXPECT_EQ(found.output.find("  limited", absent), std::string::npos) << "in order of weight";
  EXPECT_EQ(found.output.find("  ready", absent), std::string::npos);
  const auto nowhere = run_command("haptrial doctor '" + (folder / "none").string() + "'");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_THAT(nowhere.output, HasSubstr("BROKEN"));
  EXPECT_TRUE(fs::is_empty(folder.path())) << "it leaves nothing behind";
}

TEST(StartTest, TheDoctorOfADefinitionKnowsWhatItsSessionsNeed) {
  const test::TemporaryFolder folder;
  const std::string in_folder = "cd '" + folder.path().string() + "'; ";
  const std::string sound = "[sounds.go]\ntype = \"click\"\nlevel = -30.0\n";
  const std::string silent = std::string(example_named("first_experiment").text);
  test::write_text(folder / "silent.toml", silent);
  test::write_text(folder / "sounding.toml", silent + sound);
  // No card is found without ALSA's configuration.
  const std::string deaf = in_folder + "export ALSA_CONFIG_PATH=/dev/null; haptrial doctor ";
  const auto without = run_command(deaf + "silent.toml");
  EXPECT_EQ(without.status, 0) << without.output;
  EXPECT_THAT(without.output, testing::ContainsRegex("\nsound +unused "));
  EXPECT_THAT(without.output, HasSubstr("Sessions of first_experiment can run here"));
  const auto with = run_command(deaf + "sounding.toml");
  EXPECT_THAT("\n" + with.output, testing::ContainsRegex("\nsound +limited "));
  EXPECT_EQ(run_command(in_folder + "haptrial doctor none.toml").status, 2);
}

/// Half a second has 500 ticks of 1 ms, however late each is.
TEST(StartTest, TheClocksTicksAreCounted) {
  EXPECT_THAT(check_clock(0.5, 1000.0).found, testing::StartsWith("500 ticks at 1 kHz"));
}

}  // namespace
}  // namespace haptrial::experiments
