// The shipped construct-validity study on labelled bones of people: only the line `bones` changes.
// Their mirror images are left ears: for these the lines of the placement change too.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/bone/data/bone_file.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/load_bone.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/simulated_rater.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/placement_legend.h"
#include "protocols/bone_drilling/display/placement_picture.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/sanitizer.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct RealEar {
  const char* file;
  bool left;  // its mirror image
};

class RealAnatomyTest : public testing::TestWithParam<RealEar> {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer || test::kAddressSanitizer) {
      GTEST_SKIP() << "bones of millions of voxels take too long under a sanitizer";
    }
    const bool large = std::string(GetParam().file).find("256") != std::string::npos;
    if (large && GetParam().left && std::getenv("HAPTRIAL_EVERY_STUDY") == nullptr) {
      GTEST_SKIP() << "the other left ear does; set HAPTRIAL_EVERY_STUDY=1 for this one";
    }
    const auto file = test::shared_data(GetParam().file);
    if (!file) {
      GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds " << GetParam().file;
    }
    std::string text =
        test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/construct_validity.toml");
    const auto replace = [&text](const std::string& line, const std::string& other) {
      const auto at = text.find(line);
      ASSERT_NE(at, std::string::npos) << line;
      text.replace(at, line.size(), other);
    };
    replace("bones = [\"procedural temporal\"]",
            "bones = [\"" + (GetParam().left ? "left.nrrd" : file->string()) + "\"]");
    if (GetParam().left) {
      bone::save_bone(folder_ / "left.nrrd", bone::mirrored(bone::load_bone(*file)));
      replace("x_to = [0.0, -1.0, 0.0]", "place = \"surgeon's view of a left ear\"");
      replace("y_to = [0.0, 0.0, 1.0]", "");
    }
    test::write_text(folder_ / "study.toml", text);
    d_ = protocols::load_bone_definition(folder_ / "study.toml");
  }
  const bone::BoneModel& model() const { return *d_.bones.front(); }
  Eigen::Isometry3d pose() const { return pose_of(d_.placement, model().grid); }
  std::vector<float> planned() const {
    const subject::DrillingChart& chart = *d_.charts.front();
    return subject::cavity_depths(model(), pose(), chart, subject::cavity_floor(chart));
  }
  Eigen::Vector3d middle_of(const std::string& name) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    each_voxel([&](const Eigen::Vector3d& p_B, std::size_t at) {
      if (model().structures[model().labels[at]].name == name) {
        sum += p_B;
        ++count;
      }
    });
    EXPECT_GT(count, 0) << name;
    return sum / count;
  }
  template <class Visit>
  void each_voxel(const Visit& visit) const {
    const geometry::VoxelGrid& g = model().grid;
    geometry::visit_voxels(
        g, [&](const bone::Voxel& voxel, std::size_t at) { visit(g.centre(voxel), at); });
  }

  test::TemporaryFolder folder_;
  protocols::BoneDefinition d_;
};

TEST_P(RealAnatomyTest, TheCavityLiesWhereSurgeonsOpenTheMastoidInSightAndReach) {
  const std::vector<float> depths = planned();
  const Camera& view = d_.simulator.camera.start;
  const Eigen::Vector3d forward = (view.target - view.eye).normalized();
  const Eigen::Vector3d right = forward.cross(view.up).normalized();
  const double aspect = static_cast<double>(d_.display.width) / d_.display.height;
  Eigen::Vector3d opening = Eigen::Vector3d::Zero();
  int top = 0;
  int all = 0;
  double outermost = 0.0;  // 1: the edge of the picture
  double farthest = 0.0;
  each_voxel([&](const Eigen::Vector3d& p_B, std::size_t at) {
    if (depths[at] < 0.0F) {
      return;
    }
    ++all;
    const Eigen::Vector3d p_W = pose() * p_B;
    const Eigen::Vector3d seen = (p_W - view.eye) / (p_W - view.eye).dot(forward);
    const double edge = std::tan(0.5 * view.field_of_view);
    outermost = std::max({outermost, std::abs(seen.dot(right)) / (aspect * edge),
                          std::abs(seen.dot(right.cross(forward))) / edge});
    farthest = std::max(farthest, d_.drilling.scale * p_W.norm());
    if (depths[at] < 1e-3F) {
      opening += p_B;
      ++top;
    }
  });
  ASSERT_GT(top, 0);
  opening /= top;
  const double volume = all * std::pow(model().grid.spacing, 3);
  EXPECT_GT(volume, 0.5e-6);  // a cortical mastoidectomy takes a few cubic centimetres
  EXPECT_LT(volume, 10e-6);
  EXPECT_LT(outermost, 1.0);
  EXPECT_LT(farthest, d_.envelope.workspace_radius - 0.01);
  // Places are in the patient's axes: x to the left, y to the back, z up.
  const Eigen::Vector3d canal = middle_of("external auditory canal");
  const double outwards = GetParam().left ? 1.0 : -1.0;
  EXPECT_GT(outwards * (opening.x() - middle_of("incus").x()), 5e-3)
      << "is not on the side of the skull";
  EXPECT_GT(opening.y(), canal.y()) << "is not behind the canal";
  EXPECT_LT(opening.y(), canal.y() + 30e-3) << "is not near the canal";
}

TEST_P(RealAnatomyTest, ThePictureBeforeASessionHasTheCavityAndEveryNameInSight) {
  if (!GetParam().left) {
    d_.display.width = 640;  // half a picture does for one of both
    d_.display.height = 360;
  }
  const protocols::PlacedBone bone = protocols::placed_bone(d_, 0);
  EXPECT_THAT(protocols::placement_words(bone),
              testing::HasSubstr(GetParam().left ? "a left ear, by its structures; placed as"
                                                 : "a right ear, by its structures"));
  for (const auto& one : protocols::placed_structures(bone)) {
    EXPECT_TRUE(one.in_sight) << one.name;
  }
  const render::Image image = protocols::placement_picture(bone);
  ASSERT_EQ(image.width, d_.display.width);
  std::size_t red = 0;  // unlike bone and words: the cavity
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    const int green = std::max(image.rgb[at + 1], image.rgb[at + 2]);
    red += image.rgb[at] > green + 60 ? 1 : 0;
  }
  EXPECT_GT(red, image.rgb.size() / 3 / 50);
}

TEST_P(RealAnatomyTest, TheOtherEarsViewIsRefused) {
  d_.placement.left_ear = !d_.placement.left_ear;
  d_.placement.turn.col(0) *= -1.0;
  d_.placement.turn.col(2) *= -1.0;
  const std::string words = test::message_of(
      [this] { check_placement(d_.placement, model(), d_.simulator.camera.start, &*d_.cavity); });
  EXPECT_THAT(words, testing::HasSubstr("from inside the skull; it is a "));
  EXPECT_THAT(words, testing::HasSubstr(GetParam().left ? "view of a left ear" : "a right ear"));
}

TEST_P(RealAnatomyTest, AVirtualSurgeonDrillsItAndItIsRatedAndReported) {
  constexpr double kSeconds = 15.0;
  d_.drilling.time_limit = kSeconds;
  DryRun dry;
  dry.participants = 1;
  dry.max_trials = 1;
  dry.folder = folder_ / "sessions";
  const DryRunSummary summary = run_dry(protocols::bone_drilling(), d_, dry);
  EXPECT_EQ(summary.aborted_passes, 0);
  const std::vector<fs::path> files = session_files(dry.folder);
  ASSERT_EQ(files.size(), 1U);
  const record::SessionReader session(files.front());
  const std::vector<record::RemovalRow> removals = session.rows<record::RemovalRow>();
  const std::vector<float> depths = planned();
  double in_plan = 0.0;
  for (const record::RemovalRow& row : removals) {
    EXPECT_FALSE(model().structures[row.label].vital) << model().structures[row.label].name;
    const auto at = model().grid.index(row.voxel[0], row.voxel[1], row.voxel[2]);
    in_plan += depths[at] >= 0.0F ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(removals.size());
  EXPECT_GT(count * std::pow(model().grid.spacing, 3), 50e-9);
  EXPECT_GT(in_plan, 0.9 * count) << "a skilled one drills what is asked for";
  const auto ratings = simulate_ratings(dry.folder, 1);
  ASSERT_EQ(ratings.size(), simulated_raters().size());
  test::write_text(dry.folder / kRatingsFile, analysis::drilling::ratings_csv(ratings));
  AnalysisRequest request;
  request.folder = request.out = dry.folder;
  request.files = study_files(dry.folder, Pilots::kLeftOut, protocol_of);
  request.threads = 2;
  analyze_drillings(request);
  EXPECT_THAT(test::read_text(dry.folder / "report.md"), testing::HasSubstr("SIMULATED"));
}

INSTANTIATE_TEST_SUITE_P(Bones, RealAnatomyTest,
                         testing::Values(RealEar{"bone/ear3_171_labels.nrrd", false},
                                         RealEar{"bone/RT138_256_labels.nrrd", false},
                                         RealEar{"bone/ear3_171_labels.nrrd", true},
                                         RealEar{"bone/RT138_256_labels.nrrd", true}),
                         [](const auto& bone) {
                           return std::string(bone.index % 2 == 0 ? "Ear3" : "Rt138") +
                                  (bone.param.left ? "Left" : "");
                         });

}  // namespace
}  // namespace haptrial::experiments
