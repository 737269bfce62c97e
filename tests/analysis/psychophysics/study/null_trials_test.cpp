// Among people who do not differ every test of the report finds a difference in one study of
// twenty. bench_null_trials counts a thousand.
#include "tests/analysis/psychophysics/study/null_trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace haptrial::test {
namespace {

class NullTrials : public testing::TestWithParam<SimulatedTask> {};

TEST_P(NullTrials, EveryTestKeepsItsLevel) {
  // A mixed model takes half a second.
  const std::size_t studies = GetParam() == SimulatedTask::kComparison ? 15 : null_studies(100);
  // A test with a level of 0.05 leaves the band once in ten million studies.
  const auto band = binomial_band(studies, 1.0 - 1e-7);
  const auto levels = null_trials(GetParam(), studies, 3, 2);
  EXPECT_GE(levels.size(), 3u);
  for (const NullLevel& level : levels) {
    std::printf("%s: %zu of %zu\n", level.test.c_str(), level.found, level.replications);
    EXPECT_LE(level.found, band.high) << level.test;
    EXPECT_GE(level.replications, studies / 2) << level.test;
  }
}

/// Newton's own step fails in the mixed model's search after it has gone without damping: the
/// search must damp anew, not try the same step for ever.
TEST(NullTrialsTest, ASearchThatMustDampAnewEnds) {
  const auto levels = null_study(SimulatedTask::kComparison, 1, 96);
  EXPECT_TRUE(std::any_of(levels.begin(), levels.end(), [](const NullLevel& level) {
    return level.test == "probit mixed model: conditions" && level.replications == 1;
  }));
}

INSTANTIATE_TEST_SUITE_P(Tasks, NullTrials,
                         testing::Values(SimulatedTask::kStaircase, SimulatedTask::kConstant,
                                         SimulatedTask::kComparison, SimulatedTask::kDetection,
                                         SimulatedTask::kMagnitude, SimulatedTask::kIdentification,
                                         SimulatedTask::kTimes));

}  // namespace
}  // namespace haptrial::test
