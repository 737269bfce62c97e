// A session of docs/worked/everyday/pursuit.toml: where the target was, and how the virtual hand
// followed it, against their laws.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/trial_rows.h"
#include "core/subject/perceiver/two_rate.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::pursuit_test {
namespace {

constexpr std::array kFrequencies{0.1, 0.25, 0.55, 0.85};
constexpr std::array kAmplitudes{0.02, 0.012, 0.006, 0.004};

/// The amplitudes of these frequencies in a signal with a thousand values a second.
std::array<std::complex<double>, 4> amplitudes_of(const Eigen::VectorXd& signal) {
  Eigen::MatrixXd basis(signal.size(), 9);
  for (Eigen::Index i = 0; i < signal.size(); ++i) {
    basis(i, 0) = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double angle = 2.0 * M_PI * kFrequencies[k] * static_cast<double>(i) / 1000.0;
      basis(i, static_cast<Eigen::Index>(1 + 2 * k)) = std::cos(angle);
      basis(i, static_cast<Eigen::Index>(2 + 2 * k)) = std::sin(angle);
    }
  }
  const Eigen::VectorXd found = basis.colPivHouseholderQr().solve(signal);
  std::array<std::complex<double>, 4> amplitudes;
  for (std::size_t k = 0; k < 4; ++k) {
    amplitudes[k] = {found[static_cast<Eigen::Index>(1 + 2 * k)],
                     -found[static_cast<Eigen::Index>(2 + 2 * k)]};
  }
  return amplitudes;
}

TEST(PursuitTest, TheTargetMovesByItsLawAndTheHandFollowsByIts) {
  const Experiment experiment =
      load_experiment(HAPTRIAL_SOURCE_DIR "/docs/worked/everyday/pursuit.toml");
  test::TemporaryFolder folder;
  SessionRequest request = test::session_request(experiment, folder / "S01.h5", 7);
  request.max_trials = 2;
  request.clock = realtime::ClockKind::kSimulated;
  run_session(request);
  const record::SessionReader file(folder / "S01.h5");
  const auto targets = file.rows<record::TargetRow>();
  ASSERT_EQ(targets.size(), 80'000u);
  int in_light_medium = 0;
  for (std::size_t trial = 0; trial < 2; ++trial) {
    const auto first = targets.begin() + static_cast<std::ptrdiff_t>(40'000 * trial);
    const auto samples = file.samples(first->sequence, 40'000);
    const double phases[] = {1.0 + static_cast<double>(trial), 1.0,
                             2.0 + 2.0 * static_cast<double>(trial), 3.0};
    constexpr int kSettled = 4000;
    Eigen::VectorXd seen(40'000 - kSettled), hand(40'000 - kSettled);
    for (int tick = 0; tick < 40'000; ++tick) {
      double x = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        x += kAmplitudes[k] * std::sin(2.0 * M_PI * kFrequencies[k] * tick / 1000.0 + phases[k]);
      }
      ASSERT_NEAR(first[tick].place.x(), x, 1e-6) << tick;
      if (tick >= kSettled) {
        seen[tick - kSettled] = x;
        hand[tick - kSettled] = samples[static_cast<std::size_t>(tick)].position.x();
      }
    }
    const auto given = amplitudes_of(seen), followed = amplitudes_of(hand);
    const std::complex<double> low = followed[0] / given[0];
    if (std::arg(low) < -2.0 * M_PI * 0.1 * 0.22) {
      continue;  // the thick medium holds the hand back
    }
    ++in_light_medium;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::complex<double> lag(1.0, 2.0 * M_PI * kFrequencies[k] * 0.1);  // half of it
      EXPECT_LT(std::abs(followed[k] / given[k] - 1.0 / (lag * lag)), 0.03) << kFrequencies[k];
    }
  }
  EXPECT_EQ(in_light_medium, 1);
}

}  // namespace

// A session of docs/worked/everyday/rotation.toml: where the cursor was, and what the virtual
// participant learnt from it, against their laws.

namespace {

constexpr double kRotation = M_PI / 6.0;
constexpr int kBaseline = 16, kRotated = 24;

class VisuomotorRotationTest : public testing::Test {
 protected:
  VisuomotorRotationTest()
      : experiment_(load_experiment(HAPTRIAL_SOURCE_DIR "/docs/worked/everyday/rotation.toml")) {
    SessionRequest request = test::session_request(experiment_, folder_ / "S01.h5", 7);
    request.max_trials = kBaseline + kRotated;
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
}  // namespace haptrial::experiments::pursuit_test
