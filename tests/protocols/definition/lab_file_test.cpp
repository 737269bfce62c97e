// A lab file, which holds the tables of devices and screen apart from the study.

#include "protocols/definition/lab_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/experiment.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/interface/study_rules.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

/// A table's text with its header, which it takes out of `text`.
std::string cut_table(std::string& text, const std::string& name) {
  const std::size_t begin = text.find("\n[" + name + "]") + 1;
  const std::size_t end = text.find("\n[", begin) + 1;
  const std::string table = text.substr(begin, end - begin);
  text.erase(begin, end - begin);
  return table;
}

class LabFileTest : public testing::Test {
 protected:
  /// The shipped study as two files.
  void SetUp() override {
    study_ = test::shipped_text();
    for (const char* table : {"screen", "device", "force_dimension"}) {
      lab_ += cut_table(study_, table);
    }
    study_ += "\n[lab]\nuse = \"room/lab.toml\"";  // without a newline at its end
    fs::create_directory(folder_ / "room");
    write();
  }

  void write() const {
    test::write_text(folder_ / "study.toml", study_);
    test::write_text(folder_ / "room/lab.toml", lab_);
  }

  std::string refusal() const {
    write();
    try {
      load_experiment(folder_ / "study.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

  std::string study_;
  std::string lab_{"# the room with the omega.3\n\n"};
  test::TemporaryFolder folder_;
};

TEST_F(LabFileTest, AKeyThatIsGivenReachesItsFile) {
  const std::vector<GivenKey> given{{"device.max_force", "20"}, {"design.participants", "5"}};
  const Experiment experiment = load_experiment(folder_ / "study.toml", "", given);
  EXPECT_EQ(experiment.definition->device.max_force, 20.0);
  EXPECT_EQ(experiment.definition->design.participants, 5);
  EXPECT_EQ(test::read_text(folder_ / "room/lab.toml"), lab_) << "the file stays as it is";
}

TEST_F(LabFileTest, MeansTheSameAsOneFile) {
  const Experiment two = load_experiment(folder_ / "study.toml");
  EXPECT_EQ(two.definition->lab, "room/lab.toml");
  EXPECT_THAT(two.definition->text, HasSubstr(study_));
  EXPECT_THAT(two.definition->text, HasSubstr(lab_));
  record::SessionInfo whole;
  whole.definition = test::shipped_text();
  const DefinitionChanges changes =
      protocols::study_changes(protocols::force_training(), whole, two.definition->text, "virtual");
  EXPECT_TRUE(changes.same_study());
  EXPECT_EQ(sentence_of(changes.free), "lab.use was absent, is \"room/lab.toml\"");
  EXPECT_EQ(protocols::lab_of(two.definition->text), "room/lab.toml");
  EXPECT_EQ(protocols::lab_of(test::shipped_text()), "");
  EXPECT_EQ(protocols::lab_of("= not toml"), "");
}

TEST_F(LabFileTest, IsReadBehindAMarkOfUtf8AndWithoutANewline) {
  lab_ = "\xef\xbb\xbf" + lab_ + "# end";
  EXPECT_EQ(refusal(), "none");
}

TEST_F(LabFileTest, ASessionFileNeedsNoOtherFile) {
  const std::string small = " --subjects 1 --trials 3 --out ";
  const CommandResult made =
      run_command("set -e; haptrial validate " + path("study.toml") + "; haptrial dry-run " +
                  path("study.toml") + small + path("two") + "; haptrial dry-run '" +
                  test::shipped_definition().string() + "'" + small + path("one"));
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("lab file: room/lab.toml\n"));
  fs::remove_all(folder_ / "room");
  fs::remove(folder_ / "study.toml");
  const CommandResult used =
      run_command("set -e; haptrial info " + path("two/S01.h5") + "; haptrial replay " +
                  path("two/S01.h5") + " --trial 1 --fps 1 --frames " + path("pictures") +
                  "; haptrial analyze " + path("two") + "; haptrial analyze " + path("one"));
  EXPECT_EQ(used.status, 0) << used.errors << used.output;
  EXPECT_THAT(used.output, HasSubstr("definition  study.toml with room/lab.toml, seed 1\n"));
  EXPECT_EQ(test::read_text(folder_ / "two/scores.csv"),
            test::read_text(folder_ / "one/scores.csv"));
  EXPECT_THAT(record::SessionReader(folder_ / "two/S01.h5").info().definition, HasSubstr(lab_));
}

TEST_F(LabFileTest, ServesStudiesThatHaveNoUseForWhatItHolds) {
  lab_ += "\n[actuators.wrist]\nchannel = 3\nfull_scale = 30.0\nunit = \"g\"\n";
  write();
  const CommandResult force = run_command("haptrial validate " + (folder_ / "study.toml").string());
  EXPECT_EQ(force.status, 0) << force.errors;
  test::write_text(folder_ / "room/lab.toml",
                   "[actuators.wrist]\nchannel = 3\nfull_scale = 30.0\nunit = \"g\"\n");
  for (const char* name : {"stiffness_discrimination.toml", "first_drilling.toml"}) {
    test::write_text(folder_ / name,
                     test::read_text(fs::path(HAPTRIAL_SOURCE_DIR "/experiments") / name) +
                         "\n[lab]\nuse = \"room/lab.toml\"\n");
    const CommandResult valid = run_command("haptrial validate " + (folder_ / name).string());
    EXPECT_EQ(valid.status, 0) << name << ": " << valid.errors;
  }
}

TEST_F(LabFileTest, HoldsOnlyTablesOfMachines) {
  lab_ = "# guidance does not belong here\n" + lab_ + "\n[guidance]\nwait = 1\n";
  const auto line = std::count(lab_.begin(), lab_.end(), '\n') - 1;
  EXPECT_EQ(
      refusal(),
      (folder_ / "room/lab.toml").string() + ":" + std::to_string(line) +
          ": guidance is not a table of a lab file; allowed: actuators, certificate, channels, "
          "device, "
          "force_dimension, gamepad, hapi, haply, mouse, open_haptics, paddle, pedal, room, "
          "screen; "
          "what belongs to the study stays in the definition");
  lab_ = "[screem]\nmonitor = 0\n";
  EXPECT_THAT(refusal(), HasSubstr("lab.toml:1: screem is not a table of a lab file; did you mean "
                                   "screen? allowed: actuators"));
  lab_ = "[lab]\nuse = \"lab.toml\"\n";
  EXPECT_THAT(refusal(), HasSubstr("lab.toml:1: lab is not a table of a lab file"));
}

TEST_F(LabFileTest, GivesNoTableASecondTime) {
  study_ += "\n[mouse]\nmax_press = 5.0\n";
  lab_ += "\n[mouse]\nmax_press = 6.0\n";
  EXPECT_THAT(refusal(),
              HasSubstr("mouse is in the definition " + (folder_ / "study.toml").string() +
                        " as well; keep the table in one of the two files"));
}

TEST_F(LabFileTest, ItsMistakesAreNamedWithItsOwnLines) {
  lab_ = "[screen]\nmonitor = -1\n" + lab_.substr(lab_.find("[device]"));
  EXPECT_THAT(refusal(), HasSubstr((folder_ / "room/lab.toml").string() +
                                   ":2: screen.monitor is -1; allowed: "));
  lab_ = "[screen\n";
  EXPECT_THAT(refusal(), HasSubstr("lab.toml:1:8: not valid TOML"));
  for (const char* text : {"\n# words\n screen = { monitor = 1 }\n", "\n\nscreen.monitor = 1\n"}) {
    lab_ = text;
    EXPECT_THAT(refusal(), HasSubstr("lab.toml:3: a key stands before the first table; write a "
                                     "header such as [device] above it"));
  }
}

TEST_F(LabFileTest, MustBeThere) {
  fs::remove_all(folder_ / "room");
  const CommandResult absent = run_command("haptrial validate " + path("study.toml"));
  EXPECT_EQ(absent.status, 2);
  const auto line = std::count(study_.begin(), study_.end(), '\n') + 1;
  EXPECT_THAT(absent.errors, HasSubstr("study.toml:" + std::to_string(line) + ": lab.use names " +
                                       (folder_ / "room/lab.toml").string() +
                                       ", which is not a file; give its path"));
  study_.replace(study_.find("use = \"room"), 3, "us");
  test::write_text(folder_ / "study.toml", study_);
  EXPECT_THAT(run_command("haptrial validate " + path("study.toml")).errors,
              HasSubstr("lab.use is missing"));
}

}  // namespace
}  // namespace haptrial::experiments
