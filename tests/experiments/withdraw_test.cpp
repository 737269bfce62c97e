// A participant who withdraws is gone from every byte below the study's folder.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "experiments/study/withdrawal.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class WithdrawTest : public testing::Test {
 protected:
  WithdrawTest() {
    run("new mine.toml && haptrial dry-run mine.toml --subjects 3 --out out/mine");
    run("analyze out/mine && haptrial export out/mine --csv out/mine/tables");
    fs::create_directories(folder_ / "backup/mine");
    fs::copy(folder_ / "out/mine/S02.h5", folder_ / "backup/mine/S02.h5");
    fs::copy(folder_ / "out/mine/S03.h5", folder_ / "backup/mine/S03.h5");
  }
  test::CommandResult run(const std::string& arguments) const {
    return test::run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
  }
  /// Files below a folder whose name or bytes have the text.
  std::vector<std::string> files_with(const std::string& text) const {
    std::vector<std::string> found;
    for (const auto& each : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = each.path().string();
      if (each.is_regular_file() && (name.find(text) != std::string::npos ||
                                     file_text(each.path()).find(text) != std::string::npos)) {
        found.push_back(name);
      }
    }
    return found;
  }
  test::TemporaryFolder folder_;
};

TEST_F(WithdrawTest, NoByteBelowTheFoldersNamesTheParticipant) {
  ASSERT_GT(files_with("S02").size(), 5u);
  const auto listed = run("withdraw out/mine S02 --also backup --dry-run");
  EXPECT_EQ(listed.status, 0) << listed.errors;
  EXPECT_THAT(
      listed.output,
      AllOf(HasSubstr("would delete out/mine/S02.h5"), HasSubstr("would delete backup/mine/S02.h5"),
            HasSubstr("would delete out/mine/report.html"), Not(HasSubstr("S03.h5"))));
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/S02.h5"));
  const auto asked = run("withdraw out/mine S02 < /dev/null");
  EXPECT_EQ(asked.status, 2);
  EXPECT_THAT(asked.errors, HasSubstr("--yes"));
  ASSERT_TRUE(fs::exists(folder_ / "out/mine/S02.h5"));

  const auto done = run("withdraw out/mine S02 --also backup --yes");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("deleted: 2 session files of S02, and "));
  EXPECT_THAT(files_with("S02"), IsEmpty());
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/S03.h5"));
  EXPECT_TRUE(fs::exists(folder_ / "backup/mine/S03.h5"));
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/tables")) << "empty folders go, too";
  EXPECT_THAT(file_text(folder_ / "out/mine/withdrawals.csv"),
              HasSubstr("time,login,sessions,made_from_sessions\n2"));

  EXPECT_EQ(run("analyze out/mine").status, 0);
  EXPECT_THAT(files_with("S02"), IsEmpty());
  const auto again = run("withdraw out/mine S02 --yes");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("S02 has no session file in out/mine"));
}

TEST_F(WithdrawTest, ExcludedFilesAndReasonsGoAndOthersStay) {
  fs::create_directories(folder_ / "out/mine/excluded");
  fs::rename(folder_ / "out/mine/S02.h5", folder_ / "out/mine/excluded/S02.h5");
  write_text(folder_ / "out/mine/excluded/reasons.csv",
             "participant,reason\nS02,left early\nS020,slept\n");
  write_text(folder_ / "out/mine/S02-session-2.h5.partial", "torn");
  write_text(folder_ / "out/mine/S020.h5.partial", "torn");
  const std::vector<std::string> kept{"S02.h5.partial.damaged", "S02.h5.partial.damaged-2",
                                      "S02.h5.partial.repaired", "S02.h5.partial.new"};
  for (const std::string& name : kept) {
    write_text(folder_ / "out/mine" / name, "what a repair or a kill left");
  }
  write_text(folder_ / "out/mine/remarks.txt", "S02 called on Monday\n");
  const auto done = run("withdraw out/mine S02 --yes");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("leaves, although it names the participant: "
                                     "out/mine/remarks.txt"));
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/S02-session-2.h5.partial"));
  for (const std::string& name : kept) {
    EXPECT_FALSE(fs::exists(folder_ / "out/mine" / name)) << name;
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/S020.h5.partial"));
  EXPECT_EQ(file_text(folder_ / "out/mine/excluded/reasons.csv"),
            "participant,reason\nS020,slept\n");
}

TEST_F(WithdrawTest, FilesOfSomebodyWithALongerIdentifierStay) {
  const std::vector<std::string> theirs{"S02-b.h5.partial", "S02-b-session-2.h5",
                                        "export/S02-b/curve.csv", "replay-S02-b.mp4"};
  const std::vector<std::string> own{"S02-session-2.h5.partial", "S02-own.csv",
                                     "export/S02/curve.csv", "replay-S02.mp4"};
  for (const char* folder : {"out/mine/export/S02-b", "out/mine/export/S02"}) {
    fs::create_directories(folder_ / folder);
  }
  for (const auto* names : {&theirs, &own}) {
    for (const std::string& name : *names) {
      write_text(folder_ / "out/mine" / name, "torn");
    }
  }
  write_text(folder_ / "out/mine/copy-of-S02.h5", "torn");
  fs::last_write_time(folder_ / "out/mine/replay-S02-b.mp4",
                      fs::last_write_time(folder_ / "out/mine/S02.h5") - std::chrono::hours(1));
  const auto done = run("withdraw out/mine S02 --yes");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("leaves, although it names the participant: "
                                     "out/mine/copy-of-S02.h5"));
  for (const std::string& name : theirs) {
    EXPECT_TRUE(fs::exists(folder_ / "out/mine" / name)) << name;
  }
  for (const std::string& name : own) {
    EXPECT_FALSE(fs::exists(folder_ / "out/mine" / name)) << name;
  }
}

TEST_F(WithdrawTest, WhatRatersSaidOfOthersStays) {
  const std::string head = "session,procedure,rater,score,simulated,comment\n";
  write_text(folder_ / "out/mine/ratings.csv",
             head + "S01.h5,1,li,3,0,\nS02.h5,1,li,4,0,\"over\ntwo lines\"\nS03.h5,1,li,5,0,\n");
  write_text(folder_ / "out/mine/checklist.csv", head + "S02.h5,1,li,4,0,\n");
  EXPECT_EQ(run("withdraw out/mine S02 --yes").status, 0);
  EXPECT_EQ(file_text(folder_ / "out/mine/ratings.csv"),
            head + "S01.h5,1,li,3,0,\nS03.h5,1,li,5,0,\n");
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/checklist.csv")) << "nothing else is in it";
}

TEST_F(WithdrawTest, StimuliDefinitionsAndOtherStudiesStay) {
  const auto old = fs::last_write_time(folder_ / "out/mine/S01.h5") - std::chrono::hours(1);
  fs::create_directories(folder_ / "stimuli/empty");
  for (const char* name : {"README.md", "stimuli/face.png", "out/mine/stimulus.png"}) {
    write_text(folder_ / name, "older than the study");
    fs::last_write_time(folder_ / name, old);
  }
  write_text(folder_ / "plan.csv", "young, but beside no session");
  EXPECT_EQ(run("withdraw . S02 --yes").status, 0);
  for (const char* name : {"mine.toml", "README.md", "stimuli/face.png", "stimuli/empty",
                           "out/mine/stimulus.png", "plan.csv", "out/mine/S01.h5"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/report.html"));
  EXPECT_THAT(files_with("S02"), IsEmpty());
}

TEST_F(WithdrawTest, ReasonsOfAStudyBelowTheFolderGo) {
  fs::create_directories(folder_ / "out/mine/excluded");
  fs::rename(folder_ / "out/mine/S02.h5", folder_ / "out/mine/excluded/S02.h5");
  write_text(folder_ / "out/mine/excluded/reasons.csv", "participant,reason\nS02,left early\n");
  EXPECT_EQ(run("withdraw out S02 --also backup --also ./out/mine --yes").status, 0)
      << "a folder that is given twice is looked through once";
  EXPECT_THAT(files_with("S02"), IsEmpty());
}

/// Exports and sheets name nobody in some folders, and sessions hold words in compressed tables.
TEST_F(WithdrawTest, FoldersWithoutNamesGoAndSessionsThatTheParticipantLedAreNamed) {
  run("new force.toml --from force_training");
  run("dry-run force.toml --subjects 2 --trials 3 --out force");
  run("dry-run force.toml --subjects 1 --trials 1 --tutor force/S02.h5:1 --out force/led");
  run("export force --curves force/curves");
  run("judge prepare force --out force/sheets");
  fs::create_directories(folder_ / "force/curves/S01");
  write_text(folder_ / "force/curves/S01/own.csv", "of S01 alone\n");
  for (const char* name : {"force/curves/002", "force/sheets/sheet-1.html", "force/led/S01.h5"}) {
    ASSERT_TRUE(fs::exists(folder_ / name)) << name;
  }
  const auto done = run("withdraw force S02 --yes");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_FALSE(fs::exists(folder_ / "force/curves/002"));
  EXPECT_FALSE(fs::exists(folder_ / "force/sheets"));
  EXPECT_TRUE(fs::exists(folder_ / "force/curves/S01/own.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "force/led/S01.h5"));
  EXPECT_THAT(done.output,
              HasSubstr("leaves, although it names the participant: force/led/S01.h5"));
}

/// S02 of another study is another person.
TEST_F(WithdrawTest, SessionsAndExportsOfAnotherStudyStay) {
  run("new other.toml && haptrial dry-run other.toml --subjects 2 --out backup/other");
  run("export backup/other --csv backup/tables && haptrial export backup/other --bids backup/bids");
  run("export out/mine --csv backup/mine_tables && haptrial export out/mine --bids "
      "backup/mine_bids");
  for (const char* table : {"tables/sessions.csv", "bids/sub-S02/sub-S02_scans.tsv"}) {
    std::string text = file_text(folder_ / "backup" / table);  // both began in one second
    for (auto at = text.find("T"); at != text.npos; at = text.find("T", at + 1)) {
      if (at > 10 && text[at - 3] == '-') {
        text.replace(at - 10, 4, "1999");
      }
    }
    write_text(folder_ / "backup" / table, text);
  }
  fs::create_directories(folder_ / "backup/other/excluded");
  write_text(folder_ / "backup/other/excluded/reasons.csv", "participant,reason\nS02,slept\n");
  const auto done = run("withdraw out/mine S02 --also backup --yes");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("deleted: 2 session files of S02, and "));
  for (const char* name : {"other/S02.h5", "other/excluded/reasons.csv", "tables/sessions.csv",
                           "tables/trials.csv", "tables/dictionary.json", "bids/participants.tsv",
                           "bids/task-other_events.json", "bids/sub-S02/sub-S02_scans.tsv"}) {
    EXPECT_TRUE(fs::exists(folder_ / "backup" / name)) << name;
  }
  for (const char* name : {"other/S02.h5", "tables/trials.csv", "bids/participants.tsv"}) {
    EXPECT_THAT(done.output, HasSubstr("leaves, although it names the participant: backup/" +
                                       std::string(name)));
  }
  for (const char* name :
       {"mine/S02.h5", "mine_tables", "mine_bids/participants.tsv", "mine_bids/sub-S02"}) {
    EXPECT_FALSE(fs::exists(folder_ / "backup" / name)) << name;
  }
}

/// A number is a participant's name in names of files; in texts it is most things else.
TEST_F(WithdrawTest, TextsDoNotNameAParticipantByAPlainNumber) {
  const fs::path out = folder_ / "numbers";
  for (const char* subject : {"1", "2"}) {
    ASSERT_EQ(
        run(std::string("run mine.toml --device virtual --trials 1 --out numbers --subject ") +
            subject)
            .status,
        0);
  }
  write_whole(out / "stimuli.csv", "level,name\n1,a\n2,b\n");
  write_whole(out / "about-1.csv", "a,b\n");
  fs::last_write_time(out / "stimuli.csv",
                      fs::last_write_time(out / "1.h5") - std::chrono::hours(1));
  const auto listed = run("withdraw numbers 1 --dry-run");
  EXPECT_EQ(listed.status, 0) << listed.errors;
  EXPECT_THAT(listed.output, AllOf(HasSubstr("would delete numbers/1.h5"),
                                   HasSubstr("would delete numbers/about-1.csv"),
                                   Not(HasSubstr("stimuli")), Not(HasSubstr("2.h5"))));
}

TEST_F(WithdrawTest, BytesOfCompressedFilesAreNoWords) {
  fs::create_directories(folder_ / "data/sub-S01");
  const fs::path theirs = folder_ / "data/sub-S01/sub-S01_physio.tsv.gz";
  write_text(theirs, "by chance \x8b\x01S02\x02");
  EXPECT_EQ(run("withdraw out/mine S02 --also data --yes").status, 0);
  EXPECT_TRUE(fs::exists(theirs));
}

TEST(HasWordTest, NeighboursDecide) {
  EXPECT_TRUE(has_word("P03", "P03"));
  EXPECT_TRUE(has_word("P03-session-2.h5", "P03"));
  EXPECT_TRUE(has_word("P030, P03", "P03"));
  EXPECT_FALSE(has_word("P030 XP03 P03_b", "P03"));
  EXPECT_FALSE(has_word("", "P03"));
}

}  // namespace
}  // namespace haptrial::experiments
