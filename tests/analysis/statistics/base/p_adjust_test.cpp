#include "analysis/statistics/base/p_adjust.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using Values = std::vector<double>;

TEST(Holm, StepsDown) {
  // Ordered 0.01, 0.02, 0.03, 0.04 times 4, 3, 2, 1, never falling.
  EXPECT_THAT(holm_adjusted(Values{0.04, 0.01, 0.03, 0.02}),
              ElementsAre(DoubleNear(0.06, 1e-15), DoubleNear(0.04, 1e-15), DoubleNear(0.06, 1e-15),
                          DoubleNear(0.06, 1e-15)));
  EXPECT_THAT(holm_adjusted(Values{0.6, 0.9}), ElementsAre(1.0, 1.0));
}

TEST(Holm, IsBetweenEachPAndBonferronis) {
  RandomStream random(31, "p values");
  for (int i = 0; i < 100; ++i) {
    Values p(1 + random.below(12));
    for (auto& value : p) {
      value = random.uniform() * random.uniform();
    }
    const Values holm = holm_adjusted(p);
    for (std::size_t k = 0; k < p.size(); ++k) {
      EXPECT_LE(p[k], holm[k]);
      EXPECT_LE(holm[k], std::min(1.0, static_cast<double>(p.size()) * p[k]));
    }
  }
}

TEST(Holm, TakesNothingAndRefusesWhatIsNoProbability) {
  EXPECT_THAT(holm_adjusted(Values{}), IsEmpty());
  EXPECT_THROW(holm_adjusted(Values{1.5}), std::invalid_argument);
  EXPECT_THROW(holm_adjusted(Values{0.1, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
