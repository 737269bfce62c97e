#include "protocols/interface/window_input.h"

#include <gtest/gtest.h>

#include <string>

namespace haptrial::protocols {
namespace {

// On a slow screen all keys of a picture arrive at once, while a tick takes one character.
TEST(WindowInputTest, KeysWaitForTheCharactersBeforeThem) {
  constexpr std::uint32_t kEnterBit = 4;
  WindowInput input;
  input.type(U'2');
  input.type(U',');
  input.type(U'5');
  input.hold(kEnterBit);
  std::u32string typed;
  for (int tick = 0; tick < 2; ++tick) {
    typed += input.take_typed();
    EXPECT_EQ(input.held(), 0u);
  }
  typed += input.take_typed();
  EXPECT_EQ(input.held(), kEnterBit) << "the tick of the last character has the key";
  EXPECT_EQ(typed, U"2,5");
  input.hold(0);
  EXPECT_EQ(input.held(), 0u);
  EXPECT_EQ(input.take_typed(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols
