// A drilling on the real clock, with servo, recorder, search and dust on threads of their own; a
// kill in the middle of it, and how it goes on.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/bone/record/drilling_tables.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string run_arguments(const test::TemporaryFolder& folder, const std::string& more = "") {
  return "run '" + (folder / "study.toml").string() + "' --subject S01 --out '" +
         (folder / "out").string() + "' " + more;
}

void expect_the_same_bones(const fs::path& file, int passes) {
  const protocols::BoneReplay replay(file);
  const protocols::ReplayVerdict verdict = replay.run(1);
  EXPECT_EQ(verdict.difference, "");
  EXPECT_EQ(verdict.passes, passes);
  EXPECT_GT(verdict.emptied, 10u);
}

TEST(LiveBoneTest, NothingIsLostAndAReplayGivesTheSameBone) {
  const test::TemporaryFolder folder;
  test::write_small_drilling(folder.path(), 8.0);
  test::LiveCommand session(run_arguments(folder));
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(" 0 lost records"));
  const fs::path file = folder / "out" / "S01.h5";
  const record::SessionReader reader(file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto procedures = reader.rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  const record::ProcedureRow& p = procedures.front();
  EXPECT_NEAR(p.left + p.cut + p.dust + p.suctioned + p.fallen, p.before, 0.05);
  expect_the_same_bones(file, 1);
}

TEST(LiveBoneTest, AfterAKillTheSessionGoesOnWithTheBoneAsItStood) {
  const test::TemporaryFolder folder;
  test::write_small_drilling(folder.path(), 20.0);
  const fs::path partial = folder / "out" / "S01.h5.partial";
  std::uint64_t removed = 0;
  {
    test::LiveCommand session(run_arguments(folder));
    ASSERT_TRUE(session.reaches([&] {
      std::error_code ignored;
      if (!fs::exists(partial, ignored)) {
        return false;
      }
      removed = record::SessionReader(partial).count<record::RemovalRow>();
      return removed > 10;
    })) << session.errors();
    session.signal(SIGKILL);
    session.wait();
  }
  EXPECT_TRUE(record::drills(record::SessionReader(partial)));
  test::LiveCommand session(run_arguments(folder, "--resume"));
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const fs::path file = folder / "out" / "S01.h5";
  const record::SessionReader reader(file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  EXPECT_GE(reader.count<record::RemovalRow>(), removed);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0].status, record::PassStatus::kAborted);
  EXPECT_EQ(passes[1].status, record::PassStatus::kCompleted);
  EXPECT_EQ(passes[1].repetition, passes[0].repetition) << "the same bone";
  EXPECT_THAT(ended.errors, HasSubstr("trial 1 continues with the bone as it was after"));
  expect_the_same_bones(file, 2);
  const auto procedures = reader.rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  const record::ProcedureRow& p = procedures.front();
  EXPECT_EQ(p.emptied, reader.count<record::RemovalRow>()) << "those before the kill too";
  EXPECT_NEAR(p.left + p.cut + p.dust + p.suctioned + p.fallen, p.before, 0.05);
  const auto tool = reader.rows<record::ToolRow>();
  EXPECT_EQ(std::count_if(tool.begin(), tool.end(), [](const auto& row) { return row.active; }),
            20000);
}

/// A bone takes seconds to prepare. Nothing is presented after them if the experimenter did not
/// want it any more.
TEST(LiveBoneTest, NoProcedureFollowsAPreparationThatWasAborted) {
  for (const std::string request : {"abort", "skip"}) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "study.toml",
                     test::drilling_with({{"time_limit", "time_limit = 4.0"},
                                          {"seed", "seed = 1\nspacing = 0.0003"}}));  // many voxels
    test::LiveCommand session(run_arguments(folder, "--trials 1 --console"));
    test::ConsolePerson person(session.line_after("console: "));
    ASSERT_TRUE(person.sees("instructions")) << session.errors();
    ASSERT_TRUE(person.ask("start"));
    ASSERT_TRUE(person.sees("preparing")) << session.errors();
    ASSERT_TRUE(person.ask(request));
    const test::CommandResult ended = session.wait();
    ASSERT_EQ(ended.status, 0) << ended.errors;
    const fs::path file = folder / "out" / (request == "abort" ? "S01.h5.partial" : "S01.h5");
    ASSERT_TRUE(fs::exists(file)) << ended.output;
    for (const record::PassRow& pass : record::SessionReader(file).passes()) {
      EXPECT_EQ(pass.status, record::PassStatus::kAborted) << request;
    }
  }
}

/// A dry run of hours, in a pass, in which dust is followed: nothing of it stays.
TEST(LiveBoneTest, AnInterruptedDryRunIsGoneAtOnce) {
  const test::TemporaryFolder folder;
  test::write_small_drilling(folder.path(), 3600.0);
  const fs::path out = folder / "out";
  test::LiveCommand dry("dry-run '" + (folder / "study.toml").string() +
                        "' --subjects 2 --jobs 2 --out '" + out.string() + "'");
  ASSERT_TRUE(dry.reaches([&] { return fs::exists(out / "S01.h5.partial"); })) << dry.errors();
  dry.signal(SIGINT);
  const test::CommandResult ended = dry.wait();
  EXPECT_NE(ended.status, 0);
  EXPECT_THAT(ended.errors, HasSubstr("interrupted"));
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace haptrial
