// The shipped osteotomy by its virtual hand: cut, moved, plated and screwed as it
// was planned, in the file, in the figures, and in the replay.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::osteotomy_session_test {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;
using testing::HasSubstr;

constexpr double kSpacing = 0.5e-3;

std::string shipped_osteotomy() {
  return test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/mandible_osteotomy.toml");
}

class OsteotomySessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::write_text(*folder_ / "study.toml", shipped_osteotomy());
    const test::CommandResult run =
        test::run_command("haptrial dry-run '" + (*folder_ / "study.toml").string() + "' --out '" +
                          (*folder_ / "out").string() + "'");
    ASSERT_EQ(run.status, 0) << run.errors;
    output_ = run.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path file() { return *folder_ / "out/S01.h5"; }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::string output_;
};
std::unique_ptr<test::TemporaryFolder> OsteotomySessionTest::folder_;
std::string OsteotomySessionTest::output_;

TEST_F(OsteotomySessionTest, TheFragmentComesToItsPlannedPlaceAndIsHeldByScrews) {
  const record::SessionReader reader(file());
  const auto procedures = drilling::load_procedures(reader, procedure_setup(reader));
  ASSERT_EQ(procedures.size(), 1U);
  drilling::StudyBones bones;
  const drilling::Achieved achieved = drilling::summarize(procedures[0], {}, bones).achieved;
  ASSERT_TRUE(achieved.fragment);
  const drilling::FragmentFit& fit = *achieved.fragment;
  ASSERT_TRUE(fit.came_off);
  // The slot is a voxel wider than the kerf at most on either side, and faces touch within one.
  EXPECT_LT(std::abs(fit.gap), 2.0 * kSpacing);
  EXPECT_LT(fit.step, 1e-3);
  EXPECT_LT(fit.turn, 0.04);
  EXPECT_LT(fit.bite_mean.value(), 2e-3);
  EXPECT_LT(fit.off_cut.value(), 0.4e-3 + kSpacing);
  EXPECT_EQ(fit.screws, 4);
  EXPECT_EQ(fit.screws_in_bone, 2);
}

TEST_F(OsteotomySessionTest, TheFragmentLiesWhereTheFileSaysAndStaysWhenItIsLetGo) {
  const record::SessionReader reader(file());
  const auto pieces = reader.rows<record::PieceRow>();
  const auto tool = reader.rows<record::ToolRow>();
  ASSERT_FALSE(pieces.empty());
  EXPECT_GT(pieces.front().voxels, 10'000);
  const std::uint64_t last = pieces.back().sequence;
  const auto carried = [](const record::ToolRow& row) { return row.piece >= 0; };
  const auto after = std::find_if(tool.rbegin(), tool.rend(), carried);
  ASSERT_NE(after, tool.rend());
  EXPECT_EQ(last, after->sequence + 1);  // the tick on which it was let go
  EXPECT_GT((pieces.back().shift - pieces.front().shift).norm(), 2e-3);
}

TEST_F(OsteotomySessionTest, TheReplayEndsWithTheSameBoneAndEveryPieceInItsPlace) {
  const test::CommandResult same = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("the same bone"));
}

/// All of the bone, the moved fragment included: as much as the labels say is left.
TEST_F(OsteotomySessionTest, TheExportedMeshHasEveryPieceWhereItLies) {
  const auto exported = [](const char* name) {
    const std::string out = (*folder_ / name).string();
    return test::run_command("haptrial bone export '" + file().string() + "' '" + out + "'").output;
  };
  EXPECT_THAT(exported("jaw.seg.nrrd"), HasSubstr("labels have them where they were cut"));
  exported("jaw.stl");
  const bone::BoneModel labels = bone::load_bone(*folder_ / "jaw.seg.nrrd");
  std::size_t left = 0;
  for (const std::uint8_t label : labels.labels) {
    left += label != 0 && !labels.structures[label].name.starts_with("removed") ? 1 : 0;
  }
  const double volume = geometry::signed_volume(geometry::read_mesh(*folder_ / "jaw.stl"));  // mm³
  const double voxel = std::pow(1e3 * labels.grid.spacing, 3);
  EXPECT_NEAR(volume, voxel * static_cast<double>(left), 0.02 * volume);
}

TEST_F(OsteotomySessionTest, AMissingToolOfTheHandIsNamed) {
  std::string text = shipped_osteotomy();
  const std::string grip = "type = \"grip\"\nreach = 0.003";
  ASSERT_NE(text.find(grip), std::string::npos);
  text.replace(text.find(grip), grip.size(), "type = \"probe\"");
  test::write_text(*folder_ / "wrong.toml", text);
  const test::CommandResult run =
      test::run_command("haptrial validate '" + (*folder_ / "wrong.toml").string() + "'");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("needs a tool of type \"grip\" in tools.in_hand"));
}

}  // namespace
}  // namespace haptrial::experiments::osteotomy_session_test
