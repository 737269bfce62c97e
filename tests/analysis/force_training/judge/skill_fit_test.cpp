// Weights of the score from judgements: planted ones are found again, random judgements claim none.
#include "analysis/force_training/judge/skill_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

struct Judged {
  Eigen::MatrixX3d parts;
  std::vector<double> judged;
  std::vector<std::size_t> people;
};

/// Curves of participants whose parts share a skill, judged by a weighted sum and noise.
Judged judged_curves(int people, int curves, const Eigen::Vector3d& weights, double noise,
                     std::uint64_t seed) {
  RandomStream random(seed, "judged");
  Judged made{Eigen::MatrixX3d(people * curves, 3), {}, {}};
  for (int person = 0; person < people; ++person) {
    const double skill = 0.5 * random.normal();
    for (int curve = 0; curve < curves; ++curve) {
      const auto row = static_cast<Eigen::Index>(made.judged.size());
      for (int part = 0; part < 3; ++part) {
        made.parts(row, part) = 3.0 + skill + random.normal();
      }
      made.judged.push_back(7.0 - made.parts.row(row).dot(weights) + noise * random.normal());
      made.people.push_back(static_cast<std::size_t>(person));
    }
  }
  return made;
}

TEST(SkillFitTest, FindsPlantedWeightsWithoutNoise) {
  const Judged made = judged_curves(6, 8, {0.2, 0.5, 0.3}, 0.0, 1);
  const auto found = fit_skill(made.parts, made.judged, made.people, 1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->shares[0].value, 0.2, 1e-9);
  EXPECT_NEAR(found->shares[1].value, 0.5, 1e-9);
  EXPECT_NEAR(found->shares[2].value, 0.3, 1e-9);
  EXPECT_NEAR(found->r_squared, 1.0, 1e-9);
  EXPECT_TRUE(found->determined);
}

TEST(SkillFitTest, IntervalsHoldPlantedWeights) {
  constexpr int kStudies = 100;
  const Eigen::Vector3d weights(0.2, 0.5, 0.3);
  int held = 0, predicted = 0;
  for (int study = 0; study < kStudies; ++study) {
    const Judged made = judged_curves(12, 6, weights, 0.5, 100 + study);
    const auto found = fit_skill(made.parts, made.judged, made.people, 1);
    ASSERT_TRUE(found);
    predicted += found->predicts;
    for (int part = 0; part < 3; ++part) {
      const JudgedShare& share = found->shares[static_cast<std::size_t>(part)];
      held += share.low <= weights[part] && weights[part] <= share.high;
    }
  }
  EXPECT_EQ(predicted, kStudies);
  EXPECT_GE(held, 273);  // 0.95 of 300 are 285, less three standard deviations of the count
  RecordProperty("held_of_300", held);
}

/// Shares of null studies that claim skill stay within the level: at most 5 % and three standard
/// deviations of a binomial.
TEST(SkillFitTest, RandomJudgementsClaimNoSkill) {
  constexpr int kStudies = 400;
  int claimed = 0;
  for (int study = 0; study < kStudies; ++study) {
    Judged made = judged_curves(8, 6, Eigen::Vector3d::Zero(), 1.0, 1000 + study);
    RandomStream random(static_cast<std::uint64_t>(study), "whole points");
    for (double& judged : made.judged) {
      judged = 1.0 + static_cast<double>(random.below(7));
    }
    const auto found = fit_skill(made.parts, made.judged, made.people, 1);
    ASSERT_TRUE(found);
    claimed += found->predicts;
    if (!found->predicts) {
      EXPECT_FALSE(found->determined);
      EXPECT_NE(found->verdict.find("do not determine"), std::string::npos);
    }
  }
  EXPECT_LE(claimed, 0.05 * kStudies + 3.0 * std::sqrt(0.05 * 0.95 * kStudies));
  RecordProperty("claimed_of_400", claimed);
}

/// Curves of one person have parts that are alike and are judged alike, although judgements follow
/// no part.
TEST(SkillFitTest, JudgementsThatArePeoplesOwnClaimNoSkill) {
  constexpr int kStudies = 400;
  int claimed = 0;
  for (int study = 0; study < kStudies; ++study) {
    Judged made = judged_curves(4, 15, Eigen::Vector3d::Zero(), 0.0, 2000 + study);
    RandomStream random(static_cast<std::uint64_t>(study), "judgements of people");
    std::vector<double> liked(4);
    for (double& person : liked) {
      person = 1.5 * random.normal();
    }
    for (std::size_t row = 0; row < made.judged.size(); ++row) {
      made.judged[row] =
          std::clamp(std::round(4.0 + liked[made.people[row]] + random.normal()), 1.0, 7.0);
    }
    const auto found = fit_skill(made.parts, made.judged, made.people, 1);
    ASSERT_TRUE(found);
    claimed += found->predicts;
  }
  EXPECT_LE(claimed, 0.05 * kStudies + 3.0 * std::sqrt(0.05 * 0.95 * kStudies));
  RecordProperty("claimed_of_400", claimed);
}

/// Percentiles of four or six people drawn again would hold planted shares in four of five studies.
TEST(SkillFitTest, IntervalsOfFewPeopleHoldPlantedWeights) {
  const Eigen::Vector3d weights(0.36, 0.6, 0.24);  // shares 0.3, 0.5, 0.2
  for (const int people : {4, 6, 12}) {
    constexpr int kStudies = 100;
    int held = 0;
    for (int study = 0; study < kStudies; ++study) {
      const Judged made = judged_curves(people, 60 / people, weights, 0.5, 3000 + study);
      const auto found = fit_skill(made.parts, made.judged, made.people, 1);
      ASSERT_TRUE(found);
      for (int part = 0; part < 3; ++part) {
        const JudgedShare& share = found->shares[static_cast<std::size_t>(part)];
        const double planted = weights[part] / weights.sum();
        held += share.low <= planted && planted <= share.high;
      }
    }
    RecordProperty("held_of_300_" + std::to_string(people), held);
    EXPECT_GE(held, 273) << people;  // 91 %: 0.95 less three standard deviations of the count
  }
}

TEST(SkillFitTest, PartsThatRiseTogetherAreNotDetermined) {
  Judged made = judged_curves(12, 6, {0.2, 0.5, 0.3}, 0.0, 3);
  RandomStream random(5, "noise");
  for (std::size_t row = 0; row < made.judged.size(); ++row) {
    const auto r = static_cast<Eigen::Index>(row);
    made.parts(r, 1) = made.parts(r, 0) + 0.01 * random.normal();
    made.parts(r, 2) = made.parts(r, 0) + 0.01 * random.normal();
    made.judged[row] = 7.0 - made.parts.row(r).mean() + 0.5 * random.normal();
  }
  const auto found = fit_skill(made.parts, made.judged, made.people, 1);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->predicts);
  EXPECT_FALSE(found->determined);
}

TEST(SkillFitTest, IsUndefinedForFewPeopleAndEqualJudgements) {
  const Judged few = judged_curves(3, 6, {0.2, 0.5, 0.3}, 0.1, 1);
  EXPECT_FALSE(fit_skill(few.parts, few.judged, few.people, 1));
  Judged same = judged_curves(6, 6, {0.2, 0.5, 0.3}, 0.1, 1);
  std::ranges::fill(same.judged, 4.0);
  EXPECT_FALSE(fit_skill(same.parts, same.judged, same.people, 1));
}

}  // namespace
}  // namespace haptrial::analysis
