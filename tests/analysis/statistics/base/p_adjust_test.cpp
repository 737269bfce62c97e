#include "analysis/statistics/base/p_adjust.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Bonferroni, MultipliesByTheNumberOfTests) {
  EXPECT_THAT(bonferroni_adjusted(Values{0.125, 0.5, 0.25}), ElementsAre(0.375, 1.0, 0.75));
}

TEST(BenjaminiHochberg, StepsUp) {
  // Ordered 0.01, 0.02, 0.03, 0.5 times 4, 2, 4/3, 1; the second and third are both 0.04.
  EXPECT_THAT(
      benjamini_hochberg_adjusted(Values{0.5, 0.01, 0.03, 0.02}),
      ElementsAre(0.5, DoubleNear(0.04, 1e-15), DoubleNear(0.04, 1e-15), DoubleNear(0.04, 1e-15)));
}

TEST(PAdjustments, StandInTheirOrder) {
  RandomStream random(31, "p values");
  for (int i = 0; i < 100; ++i) {
    Values p(1 + random.below(12));
    for (auto& value : p) {
      value = random.uniform() * random.uniform();
    }
    const Values holm = holm_adjusted(p);
    const Values bonferroni = bonferroni_adjusted(p);
    const Values discovery = benjamini_hochberg_adjusted(p);
    for (std::size_t k = 0; k < p.size(); ++k) {
      EXPECT_LE(p[k], discovery[k]);
      EXPECT_LE(discovery[k], holm[k] * (1.0 + 1e-15));
      EXPECT_LE(holm[k], bonferroni[k]);
      EXPECT_LE(bonferroni[k], 1.0);
    }
  }
}

TEST(PAdjustments, TakeNothingAndRefuseWhatIsNoProbability) {
  for (const auto adjusted : {holm_adjusted, bonferroni_adjusted, benjamini_hochberg_adjusted}) {
    EXPECT_THAT(adjusted(Values{}), IsEmpty());
    EXPECT_THROW(adjusted(Values{1.5}), std::invalid_argument);
    EXPECT_THROW(adjusted(Values{0.1, std::numeric_limits<double>::quiet_NaN()}),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace haptrial::analysis
