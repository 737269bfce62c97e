// Naive Bayes of two voxels worked by hand; that nobody is scored with what they did; that chance
// alone does not tell groups apart.

#include "analysis/bone_drilling/metrics/region_likelihood.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis::drilling {
namespace {

using Voxels = std::vector<std::uint32_t>;
using enum RegionTraining;

/// Experts remove voxel 1 (two of two) and one of them voxel 2; novices 2 (two of two) and one of
/// them 1.
struct TwoVoxels {
  Voxels one{1}, two{2}, both{1, 2};
  std::vector<RemovedRegion> regions{
      {"E1", true, one}, {"E2", true, both}, {"N1", false, two}, {"N2", false, both}};
};

TEST(RegionLikelihoodTest, TwoVoxelsByHand) {
  // With alpha = 1: p_e = (2 + 1) / 4, (1 + 1) / 4 and p_n = (1 + 1) / 4, (2 + 1) / 4.
  const TwoVoxels t;
  const auto all = region_log_ratios(t.regions, kResubstitution);
  EXPECT_NEAR(*all[0], std::log(0.75 / 0.5) + std::log(0.5 / 0.25), 1e-12);  // 1 removed, 2 left
  EXPECT_NEAR(*all[1], std::log(0.75 / 0.5) + std::log(0.5 / 0.75), 1e-12);
  EXPECT_NEAR(*all[2], std::log(0.25 / 0.5) + std::log(0.5 / 0.75), 1e-12);
  EXPECT_NEAR(*all[1], *all[3], 1e-12) << "who did it does not matter here";
  const auto removed = region_log_ratios(t.regions, kResubstitution, RegionTerms::kRemoved);
  EXPECT_NEAR(*removed[0], std::log(0.75 / 0.5), 1e-12);
  EXPECT_NEAR(*removed[1], 0.0, 1e-12);
  EXPECT_NEAR(*removed[2], std::log(0.5 / 0.75), 1e-12);
}

TEST(RegionLikelihoodTest, TwoVoxelsByHandWithOneLeftOut) {
  // Without E1: one expert, who removed both; two novices. Laplace's alpha is shared out as 1 : 2,
  // 2/3 and 4/3: p_e = (5/3) / (7/3) for both; p_n = (7/3) / (14/3), (10/3) / (14/3).
  const TwoVoxels t;
  const auto scores = region_log_ratios(t.regions, kLeaveSubjectOut);
  const double pe = 5.0 / 7.0;
  EXPECT_NEAR(*scores[0], std::log(pe / 0.5) + std::log((1.0 - pe) / (2.0 / 7.0)), 1e-12);
  // Without E1 and N1: E2 and N2 did the same. Without E1 and N2: E2 did both, N1 only 2; alpha is
  // 1 for both: p_e = 2/3, 2/3; p_n = 1/3, 2/3.
  const auto pairs = region_log_ratios(t.regions, kLeavePairOut);
  EXPECT_NEAR(*pairs[0], 0.5 * std::log((2.0 / 3.0) / (1.0 / 3.0)), 1e-12);
}

/// Procedures of people who remove each of `voxels` with a probability of their own.
struct Study {
  std::vector<Voxels> voxels;
  std::vector<RemovedRegion> regions;

  template <class Chance>
  Study(int experts, int novices, std::uint32_t count, RandomStream& random, Chance chance) {
    for (int person = 0; person < experts + novices; ++person) {
      for (int procedure = 0; procedure < 2; ++procedure) {
        Voxels own;
        for (std::uint32_t v = 0; v < count; ++v) {
          if (random.uniform() < chance(person < experts, v)) {
            own.push_back(v);
          }
        }
        voxels.push_back(own);
      }
    }
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      regions.push_back(
          {fmt::format("P{}", i / 2), i < 2 * static_cast<std::size_t>(experts), voxels[i]});
    }
  }
};

TEST(RegionLikelihoodTest, NobodyIsScoredWithWhatTheyDid) {
  // Poison: what P0 did elsewhere changes everyone's score but P0's own of the same region.
  RandomStream random(1, "poison");
  Study study(3, 4, 200, random,
              [](bool expert, std::uint32_t v) { return expert == (v < 100) ? 0.6 : 0.3; });
  const Voxels other{0, 7, 150, 151, 152, 153, 999, 1000};
  for (const RegionTraining training : {kLeaveSubjectOut, kLeavePairOut}) {
    for (const RegionTerms terms : {RegionTerms::kAll, RegionTerms::kRemoved}) {
      auto poisoned = study.regions;
      const auto before = region_log_ratios(study.regions, training, terms);
      poisoned[1].voxels = other;  // P0's second procedure
      const auto after = region_log_ratios(poisoned, training, terms);
      EXPECT_NEAR(*before[0], *after[0], 1e-9) << "P0's first procedure";
      int changed = 0;
      for (std::size_t i = 2; i < before.size(); ++i) {
        changed += std::abs(*before[i] - *after[i]) > 1e-6 ? 1 : 0;
      }
      EXPECT_GE(changed, 10);
    }
  }
  auto poisoned = study.regions;
  poisoned[1].voxels = other;
  EXPECT_GT(std::abs(*region_log_ratios(study.regions, kResubstitution)[0] -
                     *region_log_ratios(poisoned, kResubstitution)[0]),
            1e-3)
      << "resubstitution does see it";
}

double gap(const Study& study, RegionTraining training) {
  const auto scores = region_log_ratios(study.regions, training);
  double sums[2] = {0.0, 0.0};
  double counts[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < scores.size(); ++i) {
    sums[study.regions[i].expert] += *scores[i];
    counts[study.regions[i].expert] += 1.0;
  }
  return sums[1] / counts[1] - sums[0] / counts[0];
}

TEST(RegionLikelihoodTest, ChanceTellsGroupsApartOnlyWhenItsOwnDataIsUsed) {
  RandomStream random(2, "null study");
  double with_own = 0.0;
  std::vector<double> pairs;
  for (int n = 0; n < 60; ++n) {
    const Study study(4, 7, 300, random, [](bool, std::uint32_t v) { return v < 150 ? 0.7 : 0.1; });
    with_own += gap(study, kResubstitution) / 60.0;
    pairs.push_back(gap(study, kLeavePairOut));
  }
  double mean = 0.0;
  double squares = 0.0;
  for (const double gap : pairs) {
    mean += gap / 60.0;
  }
  for (const double gap : pairs) {
    squares += (gap - mean) * (gap - mean);
  }
  const double error = std::sqrt(squares / 59.0 / 60.0);
  EXPECT_GT(with_own, 10.0) << "the same people made the model and are judged by it";
  EXPECT_LT(std::abs(mean), 3.0 * error);
  EXPECT_LT(std::abs(mean), 0.1 * with_own);
}

TEST(RegionLikelihoodTest, ARealDifferenceIsFound) {
  RandomStream random(3, "real difference");
  const Study study(4, 7, 300, random,
                    [](bool expert, std::uint32_t v) { return expert == (v < 150) ? 0.7 : 0.3; });
  EXPECT_GT(gap(study, kLeavePairOut), 50.0);
  EXPECT_GT(gap(study, kLeaveSubjectOut), 50.0);
}

TEST(RegionLikelihoodTest, DealingOutLabelsKeepsItsLevel) {
  RandomStream random(7, "labels");
  int below = 0;
  for (std::uint64_t n = 0; n < 200; ++n) {
    const Study study(4, 5, 60, random, [](bool, std::uint32_t v) { return v < 30 ? 0.7 : 0.1; });
    const auto test = region_label_test(study.regions, n, 39);
    ASSERT_TRUE(test);
    EXPECT_NEAR(test->gap, gap(study, kLeavePairOut), 1e-9);
    below += test->p <= 0.05 ? 1 : 0;
  }
  // 10 of 200 are expected; 21 or more come in one of a thousand.
  EXPECT_GE(below, 2);
  EXPECT_LE(below, 20);
  const Study real(4, 5, 60, random,
                   [](bool expert, std::uint32_t v) { return expert == (v < 30) ? 0.7 : 0.3; });
  EXPECT_LE(region_label_test(real.regions, 1)->p, 0.02) << "one of 126 ways to deal them";
}

TEST(RegionLikelihoodTest, AVoxelThatNobodyRemovedSaysNothing) {
  const Voxels a{1}, b{2}, c{3}, d{4}, e{5};
  const std::vector<RemovedRegion> regions{
      {"E1", true, a}, {"E2", true, b}, {"N1", false, c}, {"N2", false, d}, {"N3", false, e}};
  for (const auto& score : region_log_ratios(regions, kLeavePairOut, RegionTerms::kRemoved)) {
    EXPECT_NEAR(*score, 0.0, 1e-12);
  }
}

TEST(RegionLikelihoodTest, GroupsThatAreLeftEmptyHaveNoScore) {
  const Voxels v{1};
  const std::vector<RemovedRegion> regions{{"E1", true, v}, {"N1", false, v}, {"N2", false, v}};
  const auto left_out = region_log_ratios(regions, kLeaveSubjectOut);
  EXPECT_FALSE(left_out[0]);
  EXPECT_TRUE(left_out[1]);
  for (const RegionScores& scores : region_scores(regions)) {
    EXPECT_FALSE(scores.score);
    EXPECT_FALSE(scores.removed_only);
    EXPECT_TRUE(scores.resubstitution);
  }
  const std::vector<RemovedRegion> both{{"X", true, v}, {"X", false, v}};
  EXPECT_THROW(region_scores(both), std::invalid_argument);
  const Voxels twice{2, 2};
  const std::vector<RemovedRegion> unsorted{{"X", true, twice}};
  EXPECT_THROW(region_scores(unsorted), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
