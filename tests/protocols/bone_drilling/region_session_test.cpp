// Sessions with forbidden regions: what is felt, what is recorded, that replay is untouched.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bone/region/forbidden_region.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::protocols::region_session_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The small drilling with regions around the nerve; its margin reaches where the hand drills.
fs::path with_regions(const fs::path& folder, const std::string& more) {
  fs::remove(folder / "slabs.nrrd");  // is written anew
  const fs::path file = test::write_small_drilling(folder, 3.0);
  test::write_text(file, test::read_text(file) +
                             "\n[forbidden]\nstructures = [\"facial nerve\"]\nmargin = 0.01\n" +
                             more + "\n");
  return file;
}

struct Recording {
  std::vector<record::CrossingRow> crossings;
  std::string condition;
  double pressed{0.0};  // mean force on the hand while it drills [N]
};

Recording record_session(const fs::path& folder, const std::string& more) {
  const BoneDefinition d = load_bone_definition(with_regions(folder, more));
  experiments::SessionRequest request =
      test::session_request(bone_drilling(), d, folder / "S01.h5", 3);
  experiments::run_session(request);
  EXPECT_EQ(BoneReplay(request.file).run(1).difference, "");
  const record::SessionReader reader(request.file);
  Recording result;
  result.crossings = reader.rows<record::CrossingRow>();
  result.condition = reader.passes().at(0).condition;
  for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
    result.pressed += sample.force.norm() / static_cast<double>(reader.sample_count());
  }
  fs::remove(request.file);
  return result;
}

TEST(RegionSessionTest, CrossingsAreRecordedAndTheForceIsFelt) {
  const test::TemporaryFolder folder;
  const Recording off = record_session(folder.path(), "given_in = \"none\"");
  const Recording hard = record_session(folder.path(), "kind = \"hard\"");
  ASSERT_FALSE(off.crossings.empty());
  ASSERT_FALSE(hard.crossings.empty());
  EXPECT_EQ(off.condition, "regions off");
  EXPECT_EQ(hard.condition, "regions on");
  double deepest_off = 0.0, deepest_hard = 0.0;
  for (const record::CrossingRow& row : off.crossings) {
    EXPECT_FALSE(row.given);
    EXPECT_LE(row.begin, row.sequence);
    deepest_off = std::max(deepest_off, row.depth);
  }
  for (const record::CrossingRow& row : hard.crossings) {
    EXPECT_TRUE(row.given);
    deepest_hard = std::max(deepest_hard, row.depth);
  }
  EXPECT_LT(deepest_hard, deepest_off) << "the region pushes the hand out";
  EXPECT_GT(hard.pressed, off.pressed);
}

TEST(RegionSessionTest, ASoundChangesNothingThatIsFelt) {
  const test::TemporaryFolder folder;
  const Recording off = record_session(folder.path(), "given_in = \"none\"");
  const Recording sound = record_session(folder.path(), "kind = \"sound\"");
  EXPECT_EQ(sound.pressed, off.pressed);
  EXPECT_EQ(sound.crossings.size(), off.crossings.size());
}

TEST(RegionSessionTest, MistakesAreSaid) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& more) {
    return test::message_of([&] { load_bone_definition(with_regions(folder.path(), more)); });
  };
  EXPECT_THAT(refusal("kind = \"wall\""), HasSubstr("allowed: soft, hard, sound"));
  EXPECT_THAT(refusal("kind = \"sound\"\nstiffness = 200.0"), HasSubstr("which gives no force"));
  EXPECT_THAT(refusal("force_limit = 50.0"), HasSubstr("at most drilling.force_limit"));
  const test::TemporaryFolder other;
  const fs::path file = test::write_small_drilling(other.path(), 3.0);
  test::write_text(file, test::read_text(file) + "\n[forbidden]\nstructures = [\"incus\"]\n");
  EXPECT_THAT(test::message_of([&] { load_bone_definition(file); }), HasSubstr("incus"));
}

}  // namespace
}  // namespace haptrial::protocols::region_session_test
