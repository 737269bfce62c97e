// The first result of a comparison of two studies keeps its level.
#include "tests/analysis/force_training/report/null_comparisons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

using test::NullSplit;

std::vector<test::NullLevel> levels_of(NullSplit split) {
  const auto file =
      std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "results/force_training/scores.csv";
  const auto scores = read_scores_csv(file_text(file), file.string()).scores;
  return test::null_comparisons(scores, split, 100, 2, 2);
}

class NullComparisons : public testing::TestWithParam<NullSplit> {};

TEST_P(NullComparisons, WhatTheyLeadWithKeepsItsLevel) {
  // 100 of them: a test with a level of 0.05 leaves the band once in ten million studies.
  const auto band = test::binomial_band(100, 1.0 - 1e-7);
  std::size_t leads = 0;
  for (const auto& level : levels_of(GetParam())) {
    if (level.leads) {
      ++leads;
      EXPECT_EQ(level.replications, 100u);
      EXPECT_LE(level.found, band.high) << level.test;
    }
  }
  EXPECT_EQ(leads, 1u);
}

INSTANTIATE_TEST_SUITE_P(Splits, NullComparisons,
                         testing::Values(NullSplit::kBlocks, NullSplit::kParticipants));

TEST(NullComparisonsOfTrials, DoNotKeepTheirLevel) {
  // The same count finds what is there to find: trials of one participant are not independent.
  const auto band = test::binomial_band(100, 1.0 - 1e-7);
  for (const auto& level : levels_of(NullSplit::kParticipants)) {
    if (level.test == "one condition: t over trials (not in the comparison)") {
      EXPECT_GT(level.found * 100, band.high * level.replications);
      return;
    }
  }
  FAIL() << "trials were not counted";
}

}  // namespace
}  // namespace haptrial::analysis
