#include "core/base/instruction_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace haptrial {
namespace {

int baseline() { return 0; }
int avx2() { return 1; }
int avx512() { return 2; }

TEST(InstructionSetTest, ChoosesTheFunctionOfTheSetOrRefusesIt) {
  const auto available = available_instruction_sets();
  const std::vector<InstructionSet> all{InstructionSet::kBaseline, InstructionSet::kAvx2,
                                        InstructionSet::kAvx512};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool there = std::find(available.begin(), available.end(), all[i]) != available.end();
    if (there) {
      EXPECT_EQ(choose(all[i], baseline, avx2, avx512)(), static_cast<int>(i));
      EXPECT_EQ(choose(all[i], baseline, avx2)(), std::min(static_cast<int>(i), 1));
      EXPECT_NO_THROW(require_instruction_set(all[i]));
    } else {
      EXPECT_THROW(choose(all[i], baseline, avx2, avx512), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace haptrial
