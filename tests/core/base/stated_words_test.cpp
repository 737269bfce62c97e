#include "core/base/stated_words.h"

#include <gtest/gtest.h>

namespace haptrial {
namespace {

TEST(StatedWordsTest, AWordIsAWholeOne) {
  EXPECT_TRUE(has_stated_word("was ill", "ill"));
  EXPECT_TRUE(has_stated_word("still ill.", "ill"));
  EXPECT_TRUE(has_stated_word("she left early, at noon", "left early"));
  EXPECT_FALSE(has_stated_word("was still unwilling", "ill"));
  EXPECT_FALSE(has_stated_word("left earlier", "left early"));
  EXPECT_FALSE(has_stated_word("P030", "P03"));
  EXPECT_FALSE(has_stated_word("", "ill"));
  EXPECT_FALSE(has_stated_word("ill", ""));
}

TEST(StatedWordsTest, CapitalsOfEveryAlphabetAreTheSame) {
  EXPECT_TRUE(has_stated_word("ILL", "ill"));
  EXPECT_TRUE(has_stated_word("Übelkeit", "übelkeit"));
  EXPECT_TRUE(has_stated_word("БОЛЬ в руке", "боль"));
  EXPECT_TRUE(has_stated_word("“ill”–and tired", "ill"));
  EXPECT_FALSE(has_stated_word("Unfälle", "Unf"));
  EXPECT_TRUE(has_stated_word("ill\xff", "ILL\xff")) << "no UTF-8";
}

}  // namespace
}  // namespace haptrial
