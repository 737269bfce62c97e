#include "analysis/psychometric/models/information_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

TEST(InformationTransferTest, PerfectAnswersTransmitTheEntropyAndGuessesNothing) {
  EXPECT_DOUBLE_EQ(*information_transfer({{5, 0, 0, 0}, {0, 5, 0, 0}, {0, 0, 5, 0}, {0, 0, 0, 5}}),
                   2.0);
  EXPECT_NEAR(*information_transfer({{2, 4, 6}, {3, 6, 9}}), 0.0, 1e-12) << "rows in proportion";
  EXPECT_DOUBLE_EQ(*information_transfer({{7, 0}, {7, 0}}), 0.0) << "one answer to all";
  EXPECT_FALSE(information_transfer({}));
  EXPECT_FALSE(information_transfer({{0, 0}}));
}

/// A binary symmetric channel with errors e transmits 1 - H(e).
TEST(InformationTransferTest, ABinaryChannelHasItsCapacity) {
  const double e = 0.1;
  EXPECT_NEAR(*information_transfer({{90, 10}, {10, 90}}),
              1.0 + e * std::log2(e) + (1.0 - e) * std::log2(1.0 - e), 1e-12);
}

TEST(InformationTransferTest, GuessesSeemToTransmitWhatMillerSays) {
  constexpr int kStudies = 2000, kTrials = 500;
  RandomStream random(1, "guesses");
  double sum = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector counts(5, std::vector<int>(5, 0));
    for (int i = 0; i < kTrials; ++i) {
      ++counts[static_cast<std::size_t>(i % 5)][random.below(5)];
    }
    sum += *information_transfer(counts);
  }
  EXPECT_NEAR(sum / kStudies, 16.0 / (2.0 * kTrials * std::log(2.0)), 0.002);
}

}  // namespace
}  // namespace haptrial::analysis
