// Drillings that begin at a bone as a recorded one left it, or with a part of the plan removed.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::protocols::beginning_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kSeconds = 4.0;

void run(const BoneDefinition& definition, const fs::path& file) {
  experiments::SessionRequest request = test::session_request(bone_drilling(), definition, file, 3);
  experiments::run_session(request);
}

/// The small drilling on other bones, beside the first session.
BoneDefinition drilling_on(const fs::path& folder, const std::string& bones) {
  fs::remove(folder / "slabs.nrrd");  // is written anew
  return load_bone_definition(test::write_small_drilling(folder, 2.0, {{"bones", bones}}));
}

/// The bone under a simulator of its own.
std::uint64_t checksum_of(const BoneDefinition& d, const bone::BoneModel& model) {
  return bone::Simulator(model, simulator_for(d, model.grid)).checksum();
}

class BeginningTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    definition_ = std::make_unique<BoneDefinition>(
        load_bone_definition(test::write_small_drilling(folder_->path(), kSeconds)));
    run(*definition_, *folder_ / "first.h5");
  }
  static void TearDownTestSuite() {
    definition_.reset();
    folder_.reset();
  }
  static fs::path first() { return *folder_ / "first.h5"; }
  /// A definition that begins at the first session's bone. @param keys  of [bone]
  static BoneDefinition beginning(const std::string& keys) {
    return drilling_on(folder_->path(), "bones = [\"first.h5\"]\n" + keys);
  }
  static std::string refusal(const std::string& keys) {
    return test::message_of([&] { beginning(keys); });
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<BoneDefinition> definition_;
};
std::unique_ptr<test::TemporaryFolder> BeginningTest::folder_;
std::unique_ptr<BoneDefinition> BeginningTest::definition_;

/// Against the checksum that the session itself wrote when it ended.
TEST_F(BeginningTest, TheEndIsTheBoneThatTheSessionLeft) {
  const BoneDefinition d = beginning("");
  const auto procedures = record::SessionReader(first()).rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.at(0).pieces, 1);
  ASSERT_GT(procedures.at(0).emptied, 0u);
  EXPECT_EQ(checksum_of(d, *d.bones.at(0)), procedures.at(0).checksum);
}

/// Against the record of removals: what was emptied before a second, and nothing else, is gone.
TEST_F(BeginningTest, ASecondIsTheBoneOfThatSecond) {
  const double at = 2.25;
  const BoneDefinition d = beginning(fmt::format("at = {}", at));
  const record::SessionReader reader(first());
  bone::BoneModel expected = bone::model_of(record::recorded_bones(reader).at(0));
  const std::uint64_t last =
      reader.passes().at(0).first_sample + static_cast<std::uint64_t>(at * reader.info().rate);
  std::size_t gone = 0;
  for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
    if (row.sequence < last) {
      expected.labels[expected.grid.index(row.voxel[0], row.voxel[1], row.voxel[2])] = 0;
      ++gone;
    }
  }
  EXPECT_GT(gone, 0u);
  EXPECT_EQ(d.bones.at(0)->labels, expected.labels);
  const auto& density = d.bones.at(0)->density;
  EXPECT_TRUE(std::any_of(density.begin(), density.end(), [](float x) {
    return x > 0.0F && x < 1.0F;
  })) << "voxels that were half removed stay so";
}

TEST_F(BeginningTest, TheNewSessionNeedsTheOldOneNoMore) {
  const BoneDefinition d = beginning("at = 2.0");
  const fs::path file = *folder_ / "second.h5";
  run(d, file);
  const fs::path hidden = *folder_ / "hidden";
  fs::rename(first(), hidden);
  const ReplayVerdict verdict = BoneReplay(file).run(1);
  fs::rename(hidden, first());
  EXPECT_EQ(verdict.difference, "");
  EXPECT_GT(verdict.emptied, 0u);
  const auto recorded = record::recorded_bones(record::SessionReader(file));
  EXPECT_TRUE(bone::same_bone(recorded.at(0), bone::record_of(*d.bones.at(0), 0)));
  EXPECT_THAT(recorded.at(0).bone.source, HasSubstr("as procedure 1 of first.h5 left it after 2"));
}

TEST_F(BeginningTest, MistakesAreSaid) {
  EXPECT_THAT(refusal("at = 99.0"), HasSubstr("ends after 4.000 s; bone.at is 99, allowed: 0 to"));
  EXPECT_THAT(refusal("procedure = 7"), HasSubstr("has no procedure 7 (bone.procedure); allowed"));
  EXPECT_THAT(refusal("at_phase = \"deep\""),
              HasSubstr("has no phase \"deep\"; allowed: a time (bone.at)"));
  EXPECT_THAT(refusal("at = 1.0\nat_phase = \"fine burr\""), HasSubstr("keep at or at_phase"));
  EXPECT_THAT(refusal("planned_to = 0.5"), HasSubstr("add a table [cavity]"));
  const auto intact = [] { drilling_on(folder_->path(), "bones = [\"slabs.nrrd\"]\nat = 1.0"); };
  EXPECT_THAT(test::message_of(intact), HasSubstr("is about a recorded session; name one (.h5)"));
  const auto missing = [] { drilling_on(folder_->path(), "bones = [\"nobody.h5\"]"); };
  EXPECT_THAT(test::message_of(missing), HasSubstr("nobody.h5"));
}

}  // namespace
}  // namespace haptrial::protocols::beginning_test
