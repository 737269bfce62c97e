#include "core/base/nearest.h"

#include <gtest/gtest.h>

namespace haptrial {
namespace {

TEST(NearestTest, DistanceCountsLettersInsertedLeftOutReplacedAndSwapped) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("devcie", "device"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("anlayze", "analyze"), 1u);
  EXPECT_EQ(edit_distance("True", "true"), 0u);
  EXPECT_EQ(edit_distance("speed", "sped"), edit_distance("sped", "speed"));
}

TEST(NearestTest, FindsWhatATypoMeantAndNothingElse) {
  const std::vector<std::string> known{"damping", "speed", "stiffness", "x"};
  EXPECT_EQ(nearest("sped", known), "speed");
  EXPECT_EQ(nearest("stifness", known), "stiffness");
  EXPECT_EQ(nearest("dampnig", known), "damping");
  EXPECT_EQ(nearest("colour", known), std::nullopt);
  EXPECT_EQ(nearest("y", known), std::nullopt) << "every letter differs";
  EXPECT_EQ(nearest("", known), std::nullopt);
  EXPECT_EQ(nearest("sped", {}), std::nullopt);
  EXPECT_EQ(nearest("run_timeout", {"wait_timeout"}), std::nullopt) << "a third differs";
  EXPECT_EQ(nearest("ab12", {"ab1", "ab2"}), "ab1") << "the first of equally near ones";
  EXPECT_EQ(nearest(std::string(1000000, 'a'), known), std::nullopt) << "and at once";
  EXPECT_EQ(did_you_mean("sped", known), "; did you mean speed?");
  EXPECT_EQ(did_you_mean("colour", known), "");
  EXPECT_EQ(not_allowed("--mode", "'sped'", known),
            "--mode is 'sped'; did you mean speed? allowed: damping, speed, stiffness, x");
  EXPECT_EQ(not_allowed("--mode", "'colour'", {"a", "b"}), "--mode is 'colour'; allowed: a, b");
}

}  // namespace
}  // namespace haptrial
