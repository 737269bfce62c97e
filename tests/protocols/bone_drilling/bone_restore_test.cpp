// A drilling that broke off goes on with the bone as it stood: files as a crash leaves them, made
// of the rows of a whole session, and sessions on the simulated clock that go on with them.

#include "protocols/bone_drilling/bone_restore.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/trial_facts.h"
#include "experiments/runner/session.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kSeconds = 8.0;
constexpr std::uint64_t kTicks = 8000;
constexpr std::uint64_t kCrash = 5000;  // ticks that reached the file

/// Rows of ticks before `end`.
template <class Row>
std::vector<Row> rows_before(const record::SessionReader& reader, std::uint64_t end) {
  std::vector<Row> rows = reader.rows<Row>();
  std::erase_if(rows, [end](const Row& row) { return row.sequence >= end; });
  return rows;
}

class BoneRestoreTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<test::TemporaryFolder>();
    definition_ = std::make_unique<protocols::BoneDefinition>(
        protocols::load_bone_definition(test::write_small_drilling(shared_->path(), kSeconds)));
    run(*shared_ / "whole.h5", false);
  }
  static void TearDownTestSuite() {
    definition_.reset();
    shared_.reset();
  }
  static SessionSummary run(const fs::path& file, bool resume) {
    SessionRequest request =
        test::session_request(protocols::bone_drilling(), *definition_, file, 3);
    request.resume = resume;
    return run_session(request);
  }
  static record::SessionReader whole() { return record::SessionReader(*shared_ / "whole.h5"); }

  /// Tables that a session of drilling has.
  static record::TableList tables() {
    return record::with_tables(record::drilling_tables(), {&record::table_of<record::DampingRow>(),
                                                           &record::table_of<record::OpeningRow>(),
                                                           &record::table_of<record::FieldRow>()});
  }

  /// FILE.partial as a crash leaves it: without a row for the pass that was under way.
  /// @param spoil  changes the voxels that were emptied
  void crash(const std::function<void(std::vector<record::RemovalRow>&)>& spoil = {}) const {
    const record::SessionReader reader = whole();
    record::SessionWriter writer(file_, reader.info(), tables(),
                                 record::rows_of(record::recorded_bones(reader)));
    writer.begin_pass(reader.begun().at(0));
    auto removals = rows_before<record::RemovalRow>(reader, kCrash);
    if (spoil) {
      spoil(removals);
    }
    writer.add(std::span<const record::ToolRow>(rows_before<record::ToolRow>(reader, kCrash)));
    writer.add(std::span<const record::RemovalRow>(removals));
    writer.add(std::span<const record::SplitRow>(rows_before<record::SplitRow>(reader, kCrash)));
    writer.add(std::span<const record::CameraRow>(rows_before<record::CameraRow>(reader, kCrash)));
    writer.append(reader.samples(0, kCrash));
    writer.add_event({1000 * 1'000'000LL + 7, "note", "early"});
    writer.add_event({(kCrash + 300) * 1'000'000LL, "note", "in the file before its ticks"});
  }
  static std::vector<std::string> texts_of(const record::SessionReader& reader,
                                           const std::string& kind) {
    std::vector<std::string> texts;
    for (const record::EventRow& event : reader.events()) {
      if (event.kind == kind) {
        texts.push_back(event.text);
      }
    }
    return texts;
  }

  static std::unique_ptr<test::TemporaryFolder> shared_;
  static std::unique_ptr<protocols::BoneDefinition> definition_;
  test::TemporaryFolder folder_;
  fs::path file_{folder_ / "S01.h5"};
};
std::unique_ptr<test::TemporaryFolder> BoneRestoreTest::shared_;
std::unique_ptr<protocols::BoneDefinition> BoneRestoreTest::definition_;

/// Against what the session itself found of its bone when it ended.
TEST_F(BoneRestoreTest, OfAWholeRecordGivesTheBoneOfTheSession) {
  const protocols::RestoredBone bone = protocols::restore_bone(*shared_ / "whole.h5", 1, 1);
  ASSERT_NE(bone.stage, nullptr) << bone.told;
  const auto procedures = whole().rows<record::ProcedureRow>();
  EXPECT_EQ(bone.stage->simulator->checksum(), procedures[0].checksum);
  EXPECT_EQ(bone.stage->simulator->emptied_so_far(), procedures[0].emptied);
  EXPECT_EQ(bone.stage->simulator->pieces(), procedures[0].pieces);
  EXPECT_EQ(bone.ticks, kTicks);
  EXPECT_THAT(bone.told, HasSubstr("as it was after 8.000 s of drilling"));
}

TEST_F(BoneRestoreTest, AfterACrashTheBoneIsThatOfAnUninterruptedSimulationOnThatTick) {
  crash();
  run(file_, true);
  std::uint64_t uninterrupted = 0;
  protocols::BoneReplay(*shared_ / "whole.h5")
      .run(1, [&](std::uint64_t tick, std::uint64_t, const bone::DrillingView&,
                  const std::shared_ptr<const protocols::BoneStage>& stage) {
        if (tick + 1 == kCrash) {
          uninterrupted = stage->simulator->checksum();
        }
      });
  std::uint64_t resumed = 0;
  std::uint64_t emptied = 0;
  protocols::BoneReplay(file_).run(1,
                                   [&](std::uint64_t tick, std::uint64_t, const bone::DrillingView&,
                                       const std::shared_ptr<const protocols::BoneStage>& stage) {
                                     if (tick + 1 == kCrash) {
                                       resumed = stage->simulator->checksum();
                                       emptied = stage->simulator->emptied_so_far();
                                     }
                                   });
  EXPECT_EQ(resumed, uninterrupted);
  EXPECT_EQ(emptied, rows_before<record::RemovalRow>(whole(), kCrash).size());
  EXPECT_GT(emptied, 10u);
}

TEST_F(BoneRestoreTest, ASessionGoesOnWithTheBoneAndTheTimeThatIsLeft) {
  crash();
  testing::internal::CaptureStderr();
  run(file_, true);
  const std::string said = testing::internal::GetCapturedStderr();
  const record::SessionReader reader(file_);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0].status, record::PassStatus::kAborted);
  EXPECT_EQ(passes[1].status, record::PassStatus::kCompleted);
  EXPECT_EQ(passes[0].repetition, 1);
  EXPECT_EQ(passes[1].repetition, 1) << "the same bone";
  EXPECT_EQ(passes[1].attempt, 2);
  const auto tool = reader.rows<record::ToolRow>();
  EXPECT_EQ(std::count_if(tool.begin(), tool.end(), [](const auto& row) { return row.active; }),
            static_cast<std::ptrdiff_t>(kTicks))
      << "what was spent before counts";
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(file_).run(1);
  EXPECT_EQ(verdict.difference, "");
  const auto procedures = reader.rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  const record::ProcedureRow& p = procedures[0];
  EXPECT_EQ(p.checksum, verdict.checksum);
  EXPECT_EQ(p.emptied, reader.count<record::RemovalRow>());
  EXPECT_GT(p.emptied, rows_before<record::RemovalRow>(reader, kCrash).size() + 10);
  EXPECT_NEAR(p.left + p.cut + p.dust + p.suctioned + p.fallen, p.before, 0.05);
  const auto told = texts_of(reader, "bone_restored");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0], testing::AllOf(HasSubstr("after 5.000 s of drilling"),
                                      HasSubstr("before the interruption may be missing")));
  EXPECT_THAT(said, HasSubstr(told[0]));
}

TEST_F(BoneRestoreTest, TimeGoesOnAfterEverythingThatIsInTheFile) {
  crash();
  run(file_, true);
  const record::SessionReader reader(file_);
  std::int64_t last = -1;
  bool resumed = false;
  for (const record::EventRow& event : reader.events()) {
    EXPECT_GE(event.time_ns, last) << event.kind;
    last = event.time_ns;
    if (event.kind == "session_resumed") {
      resumed = true;
      EXPECT_GT(event.time_ns, (kCrash + 300) * 1'000'000LL) << "after the last event before";
      EXPECT_LE(event.time_ns, reader.samples(kCrash, 1)[0].time_ns) << "at the new run's start";
    }
  }
  EXPECT_TRUE(resumed);
}

/// The second pass on a bone ends in a crash too: /begun says on which bone it was.
TEST_F(BoneRestoreTest, ASecondCrashIsOnTheSameBone) {
  crash();
  run(file_, true);
  const fs::path again = folder_ / "again.h5";
  constexpr std::uint64_t kSecond = kCrash + 2000;
  {
    const record::SessionReader reader(file_);
    record::SessionWriter writer(again, reader.info(), tables(),
                                 record::rows_of(record::recorded_bones(reader)));
    for (const record::BegunRow& begun : reader.begun()) {
      writer.begin_pass(begun);
    }
    writer.add(std::span<const record::ToolRow>(rows_before<record::ToolRow>(reader, kSecond)));
    writer.add(
        std::span<const record::RemovalRow>(rows_before<record::RemovalRow>(reader, kSecond)));
    writer.add(std::span<const record::SplitRow>(rows_before<record::SplitRow>(reader, kSecond)));
    writer.append(reader.samples(0, kSecond));
    writer.add_pass(reader.passes()[0]);
    for (const record::EventRow& event : reader.events()) {
      if (event.time_ns < static_cast<std::int64_t>(kSecond) * 1'000'000) {
        writer.add_event(event);
      }
    }
  }
  run(again, true);
  const record::SessionReader reader(again);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 3u);
  for (const record::PassRow& pass : passes) {
    EXPECT_EQ(pass.repetition, 1);
  }
  EXPECT_EQ(protocols::BoneReplay(again).run(1).difference, "");
  EXPECT_EQ(reader.rows<record::ProcedureRow>().back().emptied, reader.count<record::RemovalRow>());
}

TEST_F(BoneRestoreTest, WhereTheSimulationDiffersItBeginsWithANewBoneAndSaysSo) {
  crash([](std::vector<record::RemovalRow>& rows) { rows[rows.size() / 2].voxel[0] += 1; });
  testing::internal::CaptureStderr();
  run(file_, true);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, testing::AllOf(HasSubstr("trial 1 begins anew with a new bone"),
                                   HasSubstr("on tick ")));
  const record::SessionReader reader(file_);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[1].repetition, passes[0].repetition + 1);
  EXPECT_EQ(texts_of(reader, "bone_lost").size(), 1u);
  const auto procedures = reader.rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  EXPECT_EQ(passes[1].last_sample - passes[1].first_sample + 1, kTicks) << "all of its time";
  const protocols::RestoredBone second = protocols::restore_bone(file_, 1, 2);
  ASSERT_NE(second.stage, nullptr) << second.told;
  EXPECT_EQ(second.stage->simulator->checksum(), procedures[0].checksum);
}

TEST_F(BoneRestoreTest, ABoneThatNobodyDrilledOrAFileThatIsNoneIsSaid) {
  const protocols::RestoredBone none = protocols::restore_bone(*shared_ / "whole.h5", 1, 2);
  EXPECT_EQ(none.stage, nullptr);
  EXPECT_THAT(none.told, HasSubstr("nothing is recorded of it"));
  const protocols::RestoredBone absent = protocols::restore_bone(folder_ / "absent.h5", 1, 1);
  EXPECT_EQ(absent.stage, nullptr);
  EXPECT_THAT(absent.told, HasSubstr("absent.h5: no such file"));
}

TEST_F(BoneRestoreTest, OtherBonesThanThoseOfTheFileAreRefused) {
  crash();
  const auto bones = definition_->bones;
  auto changed = std::make_shared<bone::BoneModel>(*bones[0]);
  changed->labels[changed->grid.index(1, 1, 1)] = 0;
  definition_->bones[0] = changed;
  const std::string message = test::message_of([&] { run(file_, true); });
  definition_->bones = bones;
  EXPECT_THAT(message, HasSubstr("was recorded with another bone 1 ('slabs')"));
  EXPECT_TRUE(fs::exists(file_.string() + ".partial"));
}

}  // namespace
}  // namespace haptrial::experiments
