#include "analysis/exchange/export_psych_ds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::export_psych_ds_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ExportPsychDsTest : public testing::Test {
 protected:
  void write(const std::string& name, const SmallSession& session) {
    write_session(folder_ / name, session);
    files_.push_back(folder_ / name);
  }

  /// Output of the script that knows the specification's rules: "equal", or what is wrong.
  std::string found_by_rules() const {
    const fs::path script =
        fs::path(HAPTRIAL_SOURCE_DIR) / "tests/analysis/exchange/read_psych_ds.py";
    const fs::path log = folder_ / "log";
    std::string line = "/usr/bin/python3 '" + script.string() + "' '" + (folder_ / "out").string();
    for (const fs::path& file : files_) {
      line += "' '" + file.string();
    }
    static_cast<void>(std::system((line + "' >'" + log.string() + "' 2>&1").c_str()));
    return file_text(log);
  }

  test::TemporaryFolder folder_;
  std::vector<fs::path> files_;
};

TEST_F(ExportPsychDsTest, KeepsTheRulesAndHoldsWhatTheSessionFilesHold) {
  write("a.h5", {.subject = "P-01", .practice = 1});
  write("b.h5", {.subject = "P_2", .simulated = false, .rate = 1000.0, .pilot = true});
  const PsychDsSummary done = export_psych_ds(files_, folder_ / "out", {.authors = {"A. Author"}});
  EXPECT_EQ(done.subjects, 2u);
  EXPECT_EQ(done.sessions, 2u);
  EXPECT_EQ(done.passes, 14u);
  EXPECT_EQ(found_by_rules(), "equal\n");
}

TEST_F(ExportPsychDsTest, TheRulesAreLookedAt) {
  write("a.h5", {.subject = "P1"});
  export_psych_ds(files_, folder_ / "out", {});
  const fs::path table = folder_ / "out/data/subject-P1_session-1_data.csv";
  std::string text = file_text(table);
  text.replace(text.find("trial_type"), 10, "trial_kind");
  write_text(table, text);
  EXPECT_THAT(found_by_rules(), HasSubstr("AssertionError"));
}

TEST_F(ExportPsychDsTest, ASimulatedParticipantIsMarked) {
  write("a.h5", {.simulated = true});
  EXPECT_TRUE(export_psych_ds(files_, folder_ / "out", {.name = "Mine"}).simulated);
  EXPECT_THAT(file_text(folder_ / "out/dataset_description.json"),
              HasSubstr("\"name\": \"SIMULATED: Mine\""));
  EXPECT_THAT(file_text(folder_ / "out/README.md"), HasSubstr("SIMULATED PARTICIPANTS"));
}

TEST_F(ExportPsychDsTest, WhatAParticipantSaidStaysOut) {
  SmallSession session{.simulated = false, .note = "P01 is called Ada"};
  session.person = {"P01", "right", "18-25", "female", "yes", "said that it tickles"};
  write("a.h5", session);
  export_psych_ds(files_, folder_ / "out", {});
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    if (entry.is_regular_file()) {
      EXPECT_THAT(file_text(entry.path()), Not(HasSubstr("tickles"))) << entry.path();
      EXPECT_THAT(file_text(entry.path()), Not(HasSubstr("Ada"))) << entry.path();
    }
  }
}

TEST_F(ExportPsychDsTest, OtherStudiesAreRefusedAndLeaveNothing) {
  write("a.h5", {.subject = "P1"});
  write("b.h5", {.subject = "P2", .definition = "name = \"another\"\n"});
  EXPECT_THROW(export_psych_ds(files_, folder_ / "out", {}), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace haptrial::exchange::export_psych_ds_test
