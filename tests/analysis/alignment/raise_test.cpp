#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/alignment/kernel.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

std::vector<double> raised(InstructionSet set, std::vector<double> values, double power) {
  kernel::kernels_for(set).raise(values.data(), values.size(), power);
  return values;
}

/// Differences of all sizes that curves can have, zero among them.
std::vector<double> differences() {
  RandomStream random(1, "differences");
  std::vector<double> values{0.0, -0.0, 1.0, -1.0, 2.0, 0.5, std::sqrt(0.5), std::sqrt(2.0)};
  for (int n = 0; n < 20000; ++n) {
    values.push_back(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-12.0, 2.0)));
  }
  return values;
}

TEST(AlignmentRaiseTest, IsAsCloseToThePowerAsItSays) {
  const auto values = differences();
  for (double power : {1.01, 1.7, 2.5, 5.0, 13.3, 30.0, 100.0}) {
    const auto results = raised(InstructionSet::kBaseline, values, power);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double exact = std::pow(std::abs(values[k]), power);
      if (exact > 0x1p200) {
        continue;
      }  // beyond what the alignment takes
      ASSERT_NEAR(results[k], exact, 3e-13 * exact + 0x1p-1000) << values[k] << '^' << power;
    }
  }
  EXPECT_EQ(raised(InstructionSet::kBaseline, {0.0, -0.0, 1.0, -1.0}, 3.7),
            (std::vector<double>{0.0, 0.0, 1.0, 1.0}));
}

TEST(AlignmentRaiseTest, EveryInstructionSetGivesTheSameBits) {
  const auto values = differences();
  for (double power : {1.7, 30.0}) {
    const auto baseline = raised(InstructionSet::kBaseline, values, power);
    for (InstructionSet set : available_instruction_sets()) {
      EXPECT_EQ(raised(set, values, power), baseline) << name_of(set);
    }
  }
}

}  // namespace
}  // namespace haptrial::analysis
