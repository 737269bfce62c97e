// Every test that a report leads with keeps its level; what it does not lead with need not.
#include "tests/analysis/force_training/study/null_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

using test::NullDesign;

const std::vector<TrialScore>& shipped_scores() {
  static const auto scores = [] {
    const auto file =
        std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "results/force_training/scores.csv";
    return read_scores_csv(file_text(file), file.string()).scores;
  }();
  return scores;
}

class NullReports : public testing::TestWithParam<NullDesign> {};

TEST_P(NullReports, WhatTheyLeadWithKeepsItsLevel) {
  // 100 of them: a test with a level of 0.05 leaves the band once in ten million studies.
  const auto band = test::binomial_band(100, 1.0 - 1e-7);
  std::size_t leads = 0;
  for (const auto& count : test::null_reports(shipped_scores(), GetParam(), 100, 2, 2)) {
    if (count.leads) {
      ++leads;
      EXPECT_LE(count.found, band.high) << count.test << " of " << name_of(GetParam());
    }
  }
  EXPECT_GE(leads, 2u);
}

INSTANTIATE_TEST_SUITE_P(Designs, NullReports,
                         testing::Values(NullDesign::kOverBlocks, NullDesign::kByParticipant,
                                         NullDesign::kBetween, NullDesign::kMixed,
                                         NullDesign::kTwoWithin, NullDesign::kTwoBetween));

TEST(NullReportsOfPooledTrials, DoNotKeepTheirLevel) {
  // The same count finds what it is there to find: pooled trials are not independent.
  const auto band = test::binomial_band(100, 1.0 - 1e-7);
  for (const auto& count :
       test::null_reports(shipped_scores(), NullDesign::kByParticipant, 100, 2, 2)) {
    if (count.test == "as published: pooled analysis of variance") {
      EXPECT_GT(count.found, band.high);
      return;
    }
  }
  FAIL() << "the pooled test was not counted";
}

TEST(BinomialBand, HoldsTheExpectedNumber) {
  const auto band = test::binomial_band(400, 0.95);  // R: qbinom(c(0.025, 0.975), 400, 0.05)
  EXPECT_EQ(band.low, 12u);
  EXPECT_EQ(band.high, 29u);
}

}  // namespace
}  // namespace haptrial::analysis
