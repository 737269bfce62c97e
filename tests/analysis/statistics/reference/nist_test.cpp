#include "tests/analysis/statistics/reference/nist.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace haptrial::analysis {
namespace {

class NistAnova : public testing::TestWithParam<nist::Cap> {};

TEST_P(NistAnova, ReachesTheCapOfTheData) {
  const nist::Cap& cap = GetParam();
  const nist::Digits digits = nist::digits(cap.file);
  EXPECT_TRUE(digits.same_df);
  // Full precision where the data allow it, the cap of the data where they do not.
  const auto reached = [](double found, double limit) {
    return found >= std::min(limit, 14.5) - 0.01;
  };
  RecordProperty("digits_of_f", std::to_string(digits.f));
  EXPECT_PRED2(reached, digits.f, cap.f);
  EXPECT_PRED2(reached, digits.between, cap.between);
  EXPECT_PRED2(reached, digits.within, cap.within);
  EXPECT_PRED2(reached, digits.r_squared, std::min(cap.between, cap.within));
}

INSTANTIATE_TEST_SUITE_P(StRD, NistAnova, testing::ValuesIn(nist::caps()), [](const auto& param) {
  return std::string(param.param.file).substr(0, 6);
});

}  // namespace
}  // namespace haptrial::analysis
