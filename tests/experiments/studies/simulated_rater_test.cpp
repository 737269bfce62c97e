#include "experiments/studies/drilling/simulated_rater.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/subject/drilling/cavity_chart.h"
#include "tests/support/solid_bone.h"

namespace haptrial::experiments {
namespace {

class SimulatedRaterTest : public testing::Test {
 protected:
  SimulatedRaterTest() {
    cavity.inward = Eigen::Vector3d::UnitZ();
    cavity.offset_B = {0.0, 7e-3, 2e-3};
    chart = subject::make_chart(model, pose, cavity);
    planned = subject::cavity_depths(model, pose, chart, subject::cavity_floor(chart));
    standing.assign(model.labels.size(), 1);
  }
  Outcome outcome() const {
    return outcome_of(model, standing, subject::plan_of(model, planned), pose, chart);
  }
  void remove_plan() {
    for (std::size_t at = 0; at < planned.size(); ++at) {
      standing[at] = planned[at] >= 0.0F ? 0 : standing[at];
    }
  }

  bone::BoneModel model{test::block_with_nerve()};
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};
  subject::CavityParameters cavity;
  subject::DrillingChart chart;
  std::vector<float> planned;
  std::vector<std::uint8_t> standing;
};

TEST_F(SimulatedRaterTest, AnUntouchedBoneIsNoWork) {
  const Outcome o = outcome();
  EXPECT_GT(o.planned, 0.0);
  EXPECT_EQ(o.complete, 0.0);
  EXPECT_EQ(o.beyond, 0.0);
  EXPECT_EQ(o.injured, 0.0);
  EXPECT_NEAR(rubric_score(o), 5.0 - 4.0 * 0.9, 1e-12);
}

TEST_F(SimulatedRaterTest, ThePlanAndNothingElseIsAlmostPerfect) {
  remove_plan();
  const Outcome o = outcome();
  EXPECT_EQ(o.complete, 1.0);
  EXPECT_EQ(o.beyond, 0.0);
  EXPECT_EQ(o.injured, 0.0);
  EXPECT_GT(rubric_score(o), 4.0);
}

TEST_F(SimulatedRaterTest, WhatIsTouchedAndTooMuchIsSeen) {
  remove_plan();
  const double good = rubric_score(outcome());
  standing[model.grid.index(5, 20, 16)] = 0;  // three voxels of the nerve
  standing[model.grid.index(6, 20, 16)] = 0;
  standing[model.grid.index(7, 20, 16)] = 0;
  const Outcome injured = outcome();
  EXPECT_NEAR(injured.injured, 3e-9, 1e-15);
  EXPECT_NEAR(good - rubric_score(injured), 0.25 + 2.5 * (1.0 - std::exp(-0.05)), 1e-9);
  for (int j = 30; j < 36; ++j) {
    standing[model.grid.index(2, j, 29)] = 0;
  }
  const Outcome beyond = outcome();
  EXPECT_NEAR(beyond.beyond, 6e-9, 1e-15);
  EXPECT_NEAR(rubric_score(injured) - rubric_score(beyond), 2.0 * 6e-9 / beyond.planned, 1e-9);
}

TEST_F(SimulatedRaterTest, ARoughFloorCosts) {
  remove_plan();
  const Outcome smooth = outcome();
  EXPECT_DOUBLE_EQ(smooth.carved, smooth.roughness) << "there are no air cells";
  for (std::size_t at = 0; at < planned.size(); ++at) {
    // Every other column keeps its lower half.
    const auto i = static_cast<int>(at % 40);
    const auto j = static_cast<int>(at / 40 % 40);
    if (planned[at] > 6e-3F && (i + j) % 2 == 0) {
      standing[at] = 1;
    }
  }
  EXPECT_GT(outcome().roughness, smooth.roughness + 0.1e-3);
  EXPECT_GT(outcome().carved, smooth.carved + 0.1e-3);
  Outcome rough = smooth;
  rough.carved = 0.7e-3;
  EXPECT_NEAR(rubric_score(rough), 4.4, 1e-9);
}

TEST_F(SimulatedRaterTest, AirCellsThatTheCavityOpensAreNobodysFault) {
  // Every other column is hollow under the plan, four voxels deep.
  const auto& grid = model.grid;
  for (int k = 1; k + 4 < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = j % 2; i < grid.size[0]; i += 2) {
        if (planned[grid.index(i, j, k - 1)] < 0.0F || planned[grid.index(i, j, k)] >= 0.0F) {
          continue;
        }
        for (int deep = k; deep < k + 4; ++deep) {
          model.labels[grid.index(i, j, deep)] = 0;
          standing[grid.index(i, j, deep)] = 0;
        }
      }
    }
  }
  remove_plan();
  const Outcome perfect = outcome();
  EXPECT_GT(perfect.roughness, 0.4e-3);
  EXPECT_LT(perfect.carved, 0.1 * perfect.roughness);
  EXPECT_DOUBLE_EQ(rubric_score(perfect), 5.0);
}

TEST(RaterMannerTest, ScoresAreWholePointsAboutTheRubricWithBiasAndNoise) {
  const RaterManner rater{"strict", -0.2, 0.5};
  constexpr int kTimes = 4000;
  double sum = 0.0;
  double squares = 0.0;
  for (int n = 0; n < kTimes; ++n) {
    const double score = given_score(3.1, rater, 7, std::to_string(n));
    EXPECT_EQ(score, std::round(score));
    EXPECT_GE(score, 1.0);
    EXPECT_LE(score, 5.0);
    sum += score - 2.9;
    squares += (score - 2.9) * (score - 2.9);
  }
  // Rounding adds a variance of 1/12.
  const double deviation = std::sqrt(0.25 + 1.0 / 12.0);
  EXPECT_NEAR(sum / kTimes, 0.0, 4.0 * deviation / std::sqrt(kTimes));
  EXPECT_NEAR(std::sqrt(squares / kTimes), deviation, 0.03);
  EXPECT_EQ(given_score(3.1, rater, 7, "a"), given_score(3.1, rater, 7, "a"));
  const auto raters = simulated_raters();
  ASSERT_EQ(raters.size(), 2U);
  EXPECT_NE(raters[0].bias, raters[1].bias);
  EXPECT_NE(raters[0].noise, raters[1].noise);
}

}  // namespace
}  // namespace haptrial::experiments
