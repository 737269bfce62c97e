#include "core/base/exception_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <optional>
#include <system_error>
#include <variant>
#include <vector>

#include "core/base/error.h"

namespace haptrial::exception_words_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Caught {
  std::string sentence;
  bool bad_input{false};
};

template <class Work>
Caught caught(Work&& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return {sentence_of(error), is_bad_input(error)};
  }
  return {"nothing was thrown"};
}

TEST(ExceptionWordsTest, OwnSentencesStay) {
  const Caught input = caught([] { throw InputError("a.toml: is empty"); });
  EXPECT_EQ(input.sentence, "a.toml: is empty");
  EXPECT_TRUE(input.bad_input);
  const Caught run = caught([] { throw RunError("the disk is full"); });
  EXPECT_EQ(run.sentence, "the disk is full");
  EXPECT_FALSE(run.bad_input);
}

TEST(ExceptionWordsTest, APathThatTheSystemRefusesIsNamed) {
  const std::filesystem::path file(std::string(300, 'a'));
  const Caught long_name = caught([&] { (void)std::filesystem::file_size(file); });
  EXPECT_EQ(long_name.sentence, file.string() + ": File name too long");
  EXPECT_TRUE(long_name.bad_input);
  const Caught full = caught([&] {
    throw std::filesystem::filesystem_error("copy", "a", "b",
                                            std::make_error_code(std::errc::no_space_on_device));
  });
  EXPECT_EQ(full.sentence, "a (to b): No space left on device");
  EXPECT_FALSE(full.bad_input);
}

TEST(ExceptionWordsTest, TheLibrarysWordsGetASentence) {
  EXPECT_THAT(caught([] { throw std::bad_alloc(); }).sentence,
              HasSubstr("the memory is not enough"));
  EXPECT_THAT(caught([] { std::vector<double>().reserve(~std::size_t{0}); }).sentence,
              HasSubstr("the memory is not enough"));
  const std::variant<int, double> wrong(1);
  const Caught fault = caught([&] { (void)std::get<double>(wrong); });
  EXPECT_THAT(fault.sentence, AllOf(HasSubstr("this is a fault of haptrial"), HasSubstr("report")));
  EXPECT_FALSE(fault.bad_input);
  EXPECT_THAT(caught([] { (void)std::vector<int>().at(1); }).sentence, HasSubstr("fault"));
  EXPECT_THAT(caught([] { (void)std::optional<int>().value(); }).sentence, HasSubstr("fault"));
}

}  // namespace
}  // namespace haptrial::exception_words_test
