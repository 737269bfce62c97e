#include "protocols/psychophysics/definition/moving_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

std::vector<MovingTarget> moving_targets_in(const std::string& text) {
  Table root = Table::parse(text, "study.toml");
  Table targets = root.table("targets");
  auto all = read_moving_targets(targets);
  root.finish();
  return all;
}

TEST(MovingTargetTest, ItMovesEvenlyAndSwingsAsASumOfSines) {
  const auto targets = moving_targets_in(
      "[targets.ball]\ncentre = [0.01, 0.0, 0.0]\nvelocity = [0.0, 0.0, 0.02]\n"
      "direction = [0.0, 1.0, 0.0]\nfrequencies = [0.5, 2.0]\namplitudes = [0.03, 0.01]\n"
      "phases = [0.0, 1.5707963267948966]\n[targets.still]\n");
  ASSERT_EQ(targets.size(), 2u);
  // Half a cycle of the first, two of the second.
  EXPECT_TRUE(targets[0].at(1.0).isApprox(
      Eigen::Vector3d(0.01, 0.03 * std::sin(M_PI) + 0.01 * std::cos(4.0 * M_PI), 0.02)));
  EXPECT_TRUE(targets[0].at(0.5).isApprox(Eigen::Vector3d(0.01, 0.03 + 0.01, 0.01)));
  EXPECT_TRUE(targets[1].at(100.0).isZero());
}

TEST(MovingTargetTest, ListsThatDoNotFitEachOtherAreRefused) {
  for (const char* lists : {"amplitudes = [0.01]\n", "amplitudes = [0.01, 0.02]\nphases = [1.0]\n",
                            "", "amplitudes = [0.01, \"$size\"]\n"}) {
    EXPECT_THROW(moving_targets_in(std::string("[targets.ball]\nfrequencies = [0.1, 0.2]\n") + lists),
                 InputError)
        << lists;
  }
}

}  // namespace
}  // namespace haptrial::protocols
