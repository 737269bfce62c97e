// Words are texts, however many there are and whoever adds them.
#include "analysis/psychophysics/data/word.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace haptrial::analysis::trials::word_test {
namespace {

TEST(WordTest, IsItsText) {
  EXPECT_TRUE(Word().empty());
  EXPECT_EQ(Word(), Word(""));
  const Word stiffer("stiffer");
  EXPECT_EQ(stiffer.text(), "stiffer");
  EXPECT_EQ(stiffer, Word(std::string("stiffer")));
  EXPECT_FALSE(stiffer == Word("softer"));
  EXPECT_TRUE(stiffer == "stiffer");
  EXPECT_FALSE(stiffer == std::string("stiff"));
  EXPECT_FALSE(stiffer.empty());
}

TEST(WordTest, ThreadsAddTheSameWordsAndReadThemMeanwhile) {
  constexpr int kCount = 20'000;  // more than a block of them
  std::vector<std::vector<Word>> found(4);
  std::vector<std::thread> threads;
  for (std::vector<Word>& own : found) {
    threads.emplace_back([&own] {
      for (int i = 0; i < kCount; ++i) {
        own.emplace_back("word " + std::to_string(i));
        EXPECT_EQ(own[static_cast<std::size_t>(i / 2)].text(), "word " + std::to_string(i / 2));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(found[0][i].text(), "word " + std::to_string(i));
    ASSERT_EQ(found[0][i], found[3][i]);
  }
}

}  // namespace
}  // namespace haptrial::analysis::trials::word_test
