// A session of docs/worked/everyday/rotation.toml: where the cursor was, and what the virtual
// participant learnt from it, against their laws.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/record/read/session_reader.h"
#include "core/record/rows/cursor_row.h"
#include "core/record/rows/trial_rows.h"
#include "core/subject/perceiver/two_rate.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::visuomotor_rotation_test {
namespace {

constexpr double kRotation = M_PI / 6.0;
constexpr int kBaseline = 16, kRotated = 24;

class VisuomotorRotationTest : public testing::Test {
 protected:
  VisuomotorRotationTest()
      : experiment_(load_experiment(HAPTRIAL_SOURCE_DIR "/docs/worked/everyday/rotation.toml")) {
    SessionRequest request;
    request.protocol = &experiment_.study->protocol();
    request.definition = experiment_.definition.get();
    request.subject = "S01";
    request.seed = 7;
    request.max_trials = kBaseline + kRotated;
    request.file = folder_ / "S01.h5";
    request.clock = realtime::ClockKind::kSimulated;
    run_session(request);
  }

  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(VisuomotorRotationTest, TheCursorIsRecordedWhereItsLawHasIt) {
  const record::SessionReader file(folder_ / "S01.h5");
  std::map<std::uint64_t, Eigen::Vector3d> tools;
  for (const record::Sample& row : file.samples(0, file.sample_count())) {
    tools[row.sequence] = row.position;
  }
  std::uint64_t rotated_from = ~std::uint64_t{0};
  for (const record::PassRow& row : file.passes()) {
    rotated_from = row.block == 2 ? std::min(rotated_from, row.first_sample) : rotated_from;
  }
  const auto cursors = file.rows<record::CursorRow>();
  ASSERT_GT(cursors.size(), 20'000u);
  int shown = 0;
  for (const record::CursorRow& row : cursors) {
    const Eigen::Vector3d& tool = tools.at(row.sequence);
    const double turn = row.sequence < rotated_from ? 0.0 : kRotation;
    const double x = std::cos(turn) * tool.x() + std::sin(turn) * tool.z();
    const double z = std::cos(turn) * tool.z() - std::sin(turn) * tool.x();
    ASSERT_NEAR(row.place.x(), x, 2e-6) << row.sequence;
    ASSERT_NEAR(row.place.z(), z, 2e-6) << row.sequence;
    shown += row.shown ? 1 : 0;
  }
  EXPECT_GT(shown, 5000);
  EXPECT_LT(shown, static_cast<int>(cursors.size()));  // not while the hand is
}

TEST_F(VisuomotorRotationTest, TheParticipantAdaptsAtTwoRates) {
  const record::SessionReader file(folder_ / "S01.h5");
  const auto learnt = file.rows<record::AdaptationRow>();
  ASSERT_EQ(learnt.size(), static_cast<std::size_t>(kBaseline + kRotated));
  subject::TwoRate law;
  for (int trial = 0; trial < kBaseline + kRotated; ++trial) {
    const auto& row = learnt[static_cast<std::size_t>(trial)];
    law.learn((trial < kBaseline ? 0.0 : kRotation) - law.state());
    // Reaches end within some degrees of where they are aimed.
    EXPECT_NEAR(row.fast + row.slow, law.state(), 0.03) << trial;
  }
  EXPECT_GT(law.state(), 0.5 * kRotation);
}

}  // namespace
}  // namespace haptrial::experiments::visuomotor_rotation_test
