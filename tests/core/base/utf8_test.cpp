#include "core/base/utf8.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace haptrial {
namespace {

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
}  // namespace haptrial
