#include "analysis/psychometric/models/discrimination_task.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

struct JudgedTask {
  DiscriminationTask task;
  double share, d_prime;
};

/// dprime.oddity(), dprime.ABX(method = "diff") and dprime.SD(method = "IO") of R's psyphy 0.2-3.
constexpr JudgedTask kJudgedTasks[] = {
    {DiscriminationTask::kOddity, 0.36, 0.545390},
    {DiscriminationTask::kOddity, 0.60, 1.975585},
    {DiscriminationTask::kOddity, 0.80, 3.128594},
    {DiscriminationTask::kOddity, 0.95, 4.800714},
    {DiscriminationTask::kAbx, 0.52, 0.472318},
    {DiscriminationTask::kAbx, 0.75, 2.020038},
    {DiscriminationTask::kAbx, 0.97, 4.625318},
    {DiscriminationTask::kSameDifferent, 0.52, 0.506694},
    {DiscriminationTask::kSameDifferent, 0.75, 2.103592},
    {DiscriminationTask::kSameDifferent, 0.97, 4.328008},
    {DiscriminationTask::kOneInterval, 0.75, 1.348980},  // 2 qnorm(0.75) of R
    {DiscriminationTask::kOneInterval, 0.40, -0.506694},
};

TEST(DiscriminationTaskTest, AgreesWithPsyphy) {
  for (const JudgedTask& each : kJudgedTasks) {
    EXPECT_NEAR(*task_d_prime(each.task, each.share, 3), each.d_prime, 1e-4) << each.share;
  }
}

/// Observers who compare noisy stimuli are as often right as is computed.
TEST(DiscriminationTaskTest, SimulatedObserversAreAsOftenRight) {
  constexpr int kTrials = 100'000;
  constexpr double kD = 1.5;
  RandomStream random(1, "observers");
  int odd = 0, abx = 0, same = 0, one = 0;
  for (int i = 0; i < kTrials; ++i) {
    const double a = random.normal(), b = random.normal(), x = kD + random.normal();
    odd += std::abs(a - b) < std::min(std::abs(a - x), std::abs(b - x)) ? 1 : 0;
    const double other = kD + random.normal(), as_other = kD + random.normal();
    abx += std::abs(as_other - other) < std::abs(as_other - a) ? 1 : 0;
    const auto is_high = [](double value) { return value > kD / 2.0; };
    same += is_high(a) == is_high(b) ? 1 : 0;
    one += is_high(x) ? 1 : 0;
  }
  const auto expect = [&](int right, DiscriminationTask task) {
    EXPECT_NEAR(static_cast<double>(right) / kTrials, task_share(task, kD, 3), 0.005);
  };
  expect(odd, DiscriminationTask::kOddity);
  expect(abx, DiscriminationTask::kAbx);
  expect(same, DiscriminationTask::kSameDifferent);
  expect(one, DiscriminationTask::kOneInterval);
}

TEST(DiscriminationTaskTest, ChanceIsNoSensitivity) {
  for (const auto& [task, chance] : {std::pair(DiscriminationTask::kOddity, 1.0 / 3.0),
                                     {DiscriminationTask::kAbx, 0.5},
                                     {DiscriminationTask::kSameDifferent, 0.5}}) {
    EXPECT_NEAR(task_share(task, 0.0, 3), chance, 1e-12);
    EXPECT_EQ(*task_d_prime(task, chance - 0.1, 3), 0.0);
    EXPECT_FALSE(task_d_prime(task, 1.0, 3));
  }
}

}  // namespace
}  // namespace haptrial::analysis
