// A shape and a renderer that no file of the product knows: stated in a definition, felt, recorded,
// resumed and analysed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "core/base/definition/schema.h"
#include "core/contact/felt_body.h"
#include "core/contact/field_renderers.h"
#include "core/contact/renderer_kinds.h"
#include "core/geometry/mesh/procedural.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "core/scene/read/field_kinds.h"
#include "core/scene/read/shape_kinds.h"
#include "docs/worked/own/ring.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::own_shape_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kStiffness = 150.0;  // of ring and block [N/m]
constexpr double kTop = 0.004;        // of the block, along z [m]
constexpr double kGivenBack = 0.5;    // share of the force when the hand leaves the block
constexpr int kTrials = 4;

/// Adds both, once in this program.
void add_own_kinds() {
  static const bool added = [] {
    own::add_ring();
    return true;
  }();
  static_cast<void>(added);
}

constexpr const char* kDefinition = R"([experiment]
protocol = "trials"
name = "ring_and_block"
[design]
participants = 1
[fields.guide]
type = "spring"
to = [0.03, 0.0, 0.02]
stiffness = 150.0
damping = 8.0
limit = 3.0
fade_out = 0.0
[fields.ring]
type = "ring"
centre = [0.0, 0.0, 0.0]
radius = 0.03
tube = 0.01
stiffness = "$level"
damping = 0.0
fade_in = 0.0
[objects.block]
shape = "box"
size = [0.04, 0.04, 0.04]
centre = [0.03, 0.0, -0.016]
renderer = "lossy"
stiffness = 150.0
damping = 0.0
fade_in = 0.0
record = true
[regions.start]
type = "ring"
centre = [0.0, 0.0, 0.02]
radius = 0.03
tube = 0.006
[[stages]]
name = "approach"
fields = ["guide"]
show = ["hand", "start"]
until = { inside = "start", for = 0.05 }
timeout = { after = 3.0, then = "abort" }
[[stages]]
name = "ring"
fields = ["ring"]
until = { time = 0.5 }
[[stages]]
name = "block"
fields = ["block"]
until = { time = 0.5 }
[response]
question = "Was the ring hard?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "constant"
variable = "level"
unit = "N/m"
levels = [100.0, 150.0]
repetitions = 2
counts = "$answer == 1"
[observer]
decides = "yes"
in_stage = "ring"
criterion = 0.5
[observer.actions]
ring = { do = "stroke", direction = [0.0, 0.0, 1.0], half_length = 0.018, frequency = 2.0, normal = [1.0, 0.0, 0.0] }
block = { do = "stroke", direction = [0.0, 0.0, 1.0], half_length = 0.02, frequency = 2.0, normal = [1.0, 0.0, 0.0] }
)";

class OwnShapeTest : public testing::Test {
 protected:
  OwnShapeTest() {
    add_own_kinds();
    test::write_text(folder_ / "own.toml", kDefinition);
    experiment_ = load_experiment(folder_ / "own.toml");
  }
  SessionRequest request(const std::filesystem::path& file) const {
    return test::session_request(experiment_, file, 7);
  }
  /// Trial, level and answer of every completed pass.
  static std::vector<std::tuple<int, double, double>> answers_of(
      const record::SessionReader& file) {
    const auto passes = file.passes();
    std::map<int, double> levels;
    for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
      levels[row.pass] = row.asked;
    }
    std::vector<std::tuple<int, double, double>> answers;
    for (const record::ResponseRow& answer : file.responses()) {
      if (passes.at(static_cast<std::size_t>(answer.pass)).status ==
          record::PassStatus::kCompleted) {
        answers.emplace_back(answer.trial, levels.at(answer.pass), answer.value);
      }
    }
    return answers;
  }

  test::TemporaryFolder folder_;
  Experiment experiment_;
};

/// The distance is compared with that to a mesh of the same ring, which is 3 µm off.
TEST_F(OwnShapeTest, ItsForceIsThatOfASpringToItsMesh) {
  run_session(request(folder_ / "S01.h5"));
  const record::SessionReader file(folder_ / "S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const contact::FeltBody mesh(geometry::make_torus(0.03, 0.01, 512, 192));
  std::map<int, double> levels;
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    levels[row.pass] = row.asked;
  }
  int compared = 0;
  for (const record::StageRow& stage : file.rows<record::StageRow>()) {
    if (stage.stage != "ring") {
      continue;
    }
    for (const record::Sample& sample :
         file.samples(stage.first_sample + 1, stage.last_sample - stage.first_sample)) {
      const double depth = -mesh.distance(sample.position).distance;
      if (depth > 0.001 && depth < 0.0075) {  // the force fades over the last 2 mm
        ASSERT_NEAR(sample.force.norm(), levels.at(stage.pass) * depth, 0.003)
            << sample.position.transpose();
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20 * kTrials);
}

/// Depths are those below the block's upper face, along z.
TEST_F(OwnShapeTest, ItsRendererGivesBackAShareOfTheForce) {
  run_session(request(folder_ / "S01.h5"));
  const record::SessionReader file(folder_ / "S01.h5");
  int pressed = 0;
  int left = 0;
  for (const record::ContactRow& row : file.rows<record::ContactRow>()) {
    const auto ticks = file.samples(row.sequence - 1, 2);
    const double before = std::max(0.0, kTop - ticks.at(0).position.z());
    const double depth = kTop - ticks.at(1).position.z();
    if (depth > 0.02 || before == 0.0 || std::abs(depth - before) < 1e-6) {
      continue;  // another face is nearer, or nobody can tell which way it goes
    }
    const double share = depth > before ? 1.0 : kGivenBack;
    ASSERT_NEAR(row.force.z(), share * kStiffness * depth, 0.003) << row.sequence;
    (depth > before ? pressed : left) += 1;
  }
  EXPECT_GT(pressed, 20 * kTrials);
  EXPECT_GT(left, 20 * kTrials);
}

TEST_F(OwnShapeTest, ASessionWithThemIsResumedAndAnalysed) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  const test::TemporaryFolder sessions;
  run_session(request(folder_ / "whole.h5"));
  const auto whole = answers_of(record::SessionReader(folder_ / "whole.h5"));
  ASSERT_EQ(whole.size(), static_cast<std::size_t>(kTrials));
  test::run_and_kill(request(sessions / "S01.h5"), 2500);
  SessionRequest again = request(sessions / "S01.h5");
  again.clock = realtime::ClockKind::kReal;
  again.resume = true;
  run_session(again);
  const record::SessionReader resumed(sessions / "S01.h5");
  EXPECT_TRUE(record::check_session(resumed, known_tables()).ok);
  EXPECT_EQ(answers_of(resumed), whole);

  AnalysisRequest analysis;
  analysis.folder = analysis.out = sessions.path();
  analysis.files = study_files(sessions.path(), Pilots::kLeftOut, protocol_of);
  EXPECT_FALSE(experiment_.study->analyze(analysis).empty());
  EXPECT_THAT(test::read_text(sessions / "report.md"), HasSubstr("SIMULATED"));
}

TEST_F(OwnShapeTest, MistakesInItsKeysGetTheirSentences) {
  const auto told = [&](const std::string& from, const std::string& to) {
    std::string text = kDefinition;
    text.replace(text.find(from), from.size(), to);
    test::write_text(folder_ / "wrong.toml", text);
    return test::message_of([&] { load_experiment(folder_ / "wrong.toml"); });
  };
  EXPECT_THAT(told("tube = 0.01", "tube = 0.0"), HasSubstr("fields.ring.tube is 0"));
  EXPECT_THAT(told("tube = 0.006", "tubes = 0.006"), HasSubstr("regions.start.tube"));
  EXPECT_THAT(told("\"lossy\"", "\"lossless\""), HasSubstr("objects.block.renderer is 'lossless'"));
  EXPECT_THAT(told("record = true", "resolution = 32"),
              HasSubstr("resolution stands beside the renderer \"lossy\", which has no cells"));
}

TEST_F(OwnShapeTest, WordsThatAreTakenAreRefused) {
  EXPECT_THROW(scene::add_kind_of_shape({"ring", own::read_ring}), std::invalid_argument);
  EXPECT_THROW(scene::add_kind_of_shape({"grating", own::read_ring}), std::invalid_argument)
      << "a field has it";
  EXPECT_EQ(std::ranges::count(scene::kinds_of_shape(), "grating", &scene::KindOfShape::word), 0);
  EXPECT_THROW(contact::add_kind_of_renderer({.word = "voxel", .make = own::make_lossy}),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::experiments::own_shape_test
