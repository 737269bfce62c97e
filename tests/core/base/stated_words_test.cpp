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

TEST(StatedWordsTest, InScriptsWithoutSpacesAWordMayStandAnywhere) {
  EXPECT_TRUE(has_stated_word("眠いので", "眠い"));
  EXPECT_TRUE(has_stated_word("手が滑った", "滑"));
  EXPECT_TRUE(has_stated_word("我感到不舒服了", "不舒服"));
  EXPECT_TRUE(has_stated_word("รู้สึกง่วงมาก", "ง่วง"));
  EXPECT_TRUE(has_stated_word("少しpainあり", "pain"));
  EXPECT_FALSE(has_stated_word("眠いので", "痛い"));
  EXPECT_FALSE(has_stated_word("少しpainful", "pain"));
}

}  // namespace
}  // namespace haptrial
