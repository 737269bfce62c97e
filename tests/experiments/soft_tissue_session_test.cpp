// A drilling over soft tissue by the virtual hand: it presses through, which is an injury in the
// record, in what a study keeps of the drilling, and in the replay.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/data/bone_file.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::soft_tissue_session_test {
namespace {

using testing::HasSubstr;

constexpr double kSeconds = 10.0;
constexpr double kTearsAt = 1.5;  // [N]; the hand presses with 2.5

std::filesystem::path definition_in(const std::filesystem::path& folder, const char* soft) {
  const auto file =
      test::write_small_drilling(folder, kSeconds, {{"bones", "bones = [\"dura.nrrd\"]"}});
  bone::save_bone(folder / "dura.nrrd", test::slabs_over_dura());
  std::ofstream(file, std::ios::app) << "\n" << soft;
  return file;
}

constexpr const char* kDura =
    "[soft_tissue.dura]\nstructure = \"dura\"\nstiffness = 500.0\ntears_at = 1.5\n";

class SoftTissueSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    definition_ = std::make_unique<protocols::BoneDefinition>(
        protocols::load_bone_definition(definition_in(folder_->path(), kDura)));
    SessionRequest request =
        test::session_request(protocols::bone_drilling(), *definition_, *folder_ / "S01.h5", 3);
    run_session(request);
  }
  static void TearDownTestSuite() {
    definition_.reset();
    folder_.reset();
  }
  static record::SessionReader session() { return record::SessionReader(*folder_ / "S01.h5"); }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<protocols::BoneDefinition> definition_;
};
std::unique_ptr<test::TemporaryFolder> SoftTissueSessionTest::folder_;
std::unique_ptr<protocols::BoneDefinition> SoftTissueSessionTest::definition_;

TEST_F(SoftTissueSessionTest, ATearIsAnInjuryWithItsForceTimeAndPlace) {
  const record::SessionReader reader = session();
  const auto tears = reader.rows<record::TearRow>();
  ASSERT_GE(tears.size(), 1u);
  for (const record::TearRow& tear : tears) {
    EXPECT_EQ(tear.label, 2);
    EXPECT_GE(tear.force, kTearsAt);
    EXPECT_LT(tear.force, 2.0 * kTearsAt);
    EXPECT_NEAR(tear.place.y(), 6.5e-3, 0.5e-3) << "the dura's surface";
  }
  std::size_t told = 0;
  for (const record::EventRow& event : reader.events()) {
    told +=
        event.kind == "injury" && event.text.find("sigmoid sinus and dura torn by cutting at") == 0
            ? 1
            : 0;
  }
  EXPECT_EQ(told, tears.size());
  // Force before the tear grows to its force, and is the dura's: the hand is in no bone.
  const auto tool = reader.rows<record::ToolRow>();
  const record::ToolRow& torn = tool.at(tears.front().sequence - tool.front().sequence);
  EXPECT_NEAR(torn.contact.norm(), tears.front().force, 0.3);
  bool emptied = false;
  for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
    if (row.label == 2) {
      EXPECT_GE(row.sequence, tears.front().sequence) << "soft tissue is not drilled";
      emptied = emptied || row.sequence == tears.front().sequence;
    }
  }
  EXPECT_TRUE(emptied) << "a hole";
}

TEST_F(SoftTissueSessionTest, AStudyKeepsTheFirstTear) {
  const record::SessionReader reader = session();
  analysis::drilling::StudyBones bones;
  const auto procedures = load_procedures(reader, procedure_setup(*definition_), &bones);
  ASSERT_EQ(procedures.size(), 1u);
  const auto all = analysis::drilling::injuries(procedures[0], bones);
  ASSERT_EQ(all.size(), 1u);
  const auto tears = reader.rows<record::TearRow>();
  EXPECT_EQ(all[0].tears, tears.size());
  ASSERT_TRUE(all[0].first_tear);
  EXPECT_EQ(all[0].first_tear->force, tears[0].force);
  EXPECT_GT(all[0].first_tear->time, 0.5);
  EXPECT_LE(all[0].first_tear->time, kSeconds);
  EXPECT_GT(all[0].voxels, 0u);
  const Eigen::Vector3d place = procedures[0].pose_WB * tears[0].place;
  EXPECT_EQ(all[0].first_tear->place, place);
}

TEST_F(SoftTissueSessionTest, AReplayTearsTheSame) {
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(*folder_ / "S01.h5").run(1);
  EXPECT_EQ(verdict.difference, "");
  EXPECT_EQ(verdict.tears, session().rows<record::TearRow>().size());
  EXPECT_TRUE(verdict.whole);
}

TEST_F(SoftTissueSessionTest, ADefinitionSaysWhatIsSoft) {
  EXPECT_THAT(
      definition_->description(),
      testing::Contains(HasSubstr("soft: dura gives way with 500 N/m, tears at 1.5 N, comes "
                                  "off a tube at 0.15 N; stays calm with 0.25 N·s/m")));
}

TEST_F(SoftTissueSessionTest, MistakesAreToldInASentence) {
  const auto refusal = [&](const char* soft) {
    const test::TemporaryFolder other;
    return test::message_of(
        [&] { protocols::load_bone_definition(definition_in(other.path(), soft)); });
  };
  EXPECT_THAT(refusal("[soft_tissue.a]\nstructure = \"carotid\"\n"),
              HasSubstr("soft_tissue: the bone slabs has no structure 'carotid'; it has bone"));
  EXPECT_THAT(refusal("[soft_tissue.a]\nstructure = \"dura\"\ntears_at = 20.0\n"),
              HasSubstr("tear at 20 N, which the hand would not feel; allowed: at most "
                        "drilling.force_limit, 8 [N]"));
  EXPECT_THAT(refusal("[soft_tissue.a]\nstructure = \"dura\"\nstiffness = 0.0\n"),
              HasSubstr("soft_tissue.a.stiffness is 0; allowed: a number above 0"));
}

}  // namespace
}  // namespace haptrial::experiments::soft_tissue_session_test
