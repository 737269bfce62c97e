#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "core/base/alike_names.h"
#include "core/base/shell_word.h"
#include "core/base/short_numbers.h"
#include "core/base/stated_words.h"
#include "core/base/utf8.h"

namespace haptrial::text_test {
namespace {

TEST(ShortNumbersTest, NumbersHaveFourDigitsAndWordsStayAsTheyAre) {
  EXPECT_EQ(short_numbers("3.1415926536000001"), "3.142");
  EXPECT_EQ(short_numbers("left, 0.30000000000000004, 2b"), "left, 0.3, 2b");
  EXPECT_EQ(short_numbers("plain"), "plain");
  EXPECT_EQ(short_numbers(""), "");
}

TEST(ShellWordTest, AShellReadsTheWordBack) {
  EXPECT_EQ(shell_word("out/ä.toml"), "out/ä.toml");
  for (const std::string word : {"", "it's mine", "a b$HOME`x`\\", "~", "*"}) {
    const std::string read = "printf %s " + shell_word(word);
    FILE* pipe = ::popen(read.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string back(64, '\0');
    back.resize(std::fread(back.data(), 1, back.size(), pipe));
    ::pclose(pipe);
    EXPECT_EQ(back, word);
  }
}

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(AlikeNamesTest, FindsWhatATypoMayHaveMade) {
  EXPECT_THAT(alike_names({"visual", "haptic", "Visual", "no-guide", "no guide", "No_Guide"}),
              UnorderedElementsAre(ElementsAre("visual", "Visual"),
                                   ElementsAre("no-guide", "no guide", "No_Guide")));
  EXPECT_THAT(alike_names({"1", "P00", "01", "P0", "p0"}),
              UnorderedElementsAre(ElementsAre("1", "01"), ElementsAre("P00", "P0", "p0")));
  EXPECT_THAT(alike_names({"0.1", "0.10", "0.2", "2", "2.0"}),
              UnorderedElementsAre(ElementsAre("0.1", "0.10"), ElementsAre("2", "2.0")));
  EXPECT_THAT(alike_names({"a\u00a0b", "ab"}), UnorderedElementsAre(ElementsAre("a\u00a0b", "ab")));
}

TEST(AlikeNamesTest, LeavesDifferentNamesAlone) {
  EXPECT_THAT(alike_names({"P1", "P2", "P11", "P101", "P10", "\u00e9", "\u00e8"}), IsEmpty());
  EXPECT_THAT(alike_names({"0.5", "0.05", "0,005", "0,05", "10", "100"}), IsEmpty());
  EXPECT_THAT(alike_names({}), IsEmpty());
}

TEST(AlikeNamesTest, WarningsQuoteTheNames) {
  EXPECT_THAT(
      alike_names_warnings("participants", {"P1", "P2", "p01"}),
      ElementsAre(
          "WARNING: the names of participants differ only in blanks, hyphens, "
          "capitals or zeros that change no number and are taken for different participants: "
          "\"P1\", \"p01\"."));
}

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

// Characters of one to four bytes.
const std::vector<std::string> kCharacters{"a", "\u00e9", "\u20ac", "\U0001f600", "z"};

TEST(Utf8Test, CutsOnlyBetweenCharacters) {
  std::string text;
  std::vector<std::size_t> ends{0};
  for (const std::string& character : kCharacters) {
    text += character;
    ends.push_back(text.size());
  }
  for (std::size_t most = 0; most <= text.size() + 2; ++most) {
    const auto next = std::upper_bound(ends.begin(), ends.end(), most);
    EXPECT_EQ(whole_characters(text, most), *(next - 1)) << most;
    EXPECT_EQ(cut_text(text, most), text.substr(0, *(next - 1)));
  }
}

TEST(Utf8Test, CutsWhatIsNoUtf8WhereItWasTold) {
  EXPECT_EQ(whole_characters(std::string(9, '\x80'), 6), 6U);
  EXPECT_EQ(whole_characters("\x80\x80", 1), 1U);
}

TEST(Utf8Test, KnowsTheBytesOfACharacterByItsFirst) {
  for (const std::string& character : kCharacters) {
    EXPECT_EQ(character_bytes(character.front()), character.size());
  }
  for (const char never : {'\x80', '\xbf', '\xc0', '\xc1', '\xf5', '\xff'}) {
    EXPECT_EQ(character_bytes(never), 0U);
  }
}

}  // namespace

}  // namespace haptrial::text_test
