// Text that would reach undefined behaviour of the TOML parser is refused before it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/files/file_text.h"

namespace haptrial::toml_text_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal(const std::string& text) {
  try {
    Table::parse(text, "f.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TomlTextTest, LettersBeyondAsciiAreRefusedOutsideOfQuotes) {
  for (const std::string letter : {"é", "ß", "×", "§", "·", "Я", "ア", "\U0001f600"}) {
    for (const std::string& line :
         {letter + " = 1", "a" + letter + " = 1", "a" + letter + "b = 1", "a." + letter + " = 1",
          "[" + letter + "]", "[a" + letter + "]", "[a]" + letter, "x = " + letter,
          "x = 1" + letter, "x = 1 " + letter, "x = true" + letter, "x = [1, " + letter + "]",
          "x = [1" + letter + "]", "x = { a" + letter + " = 1 }", "x = { a = 1" + letter + " }",
          "x = 2026-01-01" + letter, "x = 2026-01-01 10:00:00" + letter, "x = \"\"" + letter}) {
      EXPECT_THAT(refusal("before = 1\n" + line + "\n"),
                  AllOf(StartsWith("f.toml:2: "), HasSubstr(letter)))
          << line;
    }
    EXPECT_THAT(refusal("\na " + letter + " = 1\n"), StartsWith("f.toml:2: no = follows a"));
    EXPECT_THAT(refusal("\n[[a " + letter + "]]\n"), StartsWith("f.toml:2: the table header"));
  }
}

TEST(TomlTextTest, AValueThatIsALetterSaysWhatIsAllowed) {
  EXPECT_EQ(refusal("x = ×\n"),
            "f.toml:1: × stands outside of quotes; write a text in quotes, and a key with letters "
            "from a to z, digits, _ and -");
}

TEST(TomlTextTest, LettersBeyondAsciiAreFineInQuotesAndComments) {
  EXPECT_EQ(refusal("\ufeff# größe\n\"größe\" = 'ß' # ×\na = \"\\\"é\"\nb = '\\' # é\n"
                    "c = \"\"\"é\n\"ß\"\\\"\"\"\"\"\"\nd = '''×'' \n§''''\ne = \"\"\n"
                    "[\"§\".'·'] # Я\nlist = [ # é\n  'é', # ß\n]\n"),
            "accepted");
}

TEST(TomlTextTest, TheBracketOfATableIsFollowedByItsName) {
  for (const char* line : {"[$x]", "[ :x]", "[[,x]]", "[#x]", "[.x]", "[", "[]", "[ [x]]", "[=]"}) {
    EXPECT_THAT(refusal("a = [\n  [1],\n]\n" + std::string(line) + "\n"), StartsWith("f.toml:4: "))
        << line;
  }
  EXPECT_EQ(refusal("a = [\n[ 1 ], # [\n[-1],\n]\n [ \"b\" ]\n[[ 'c' ]]\n"), "accepted");
}

TEST(TomlTextTest, BracketsAreClosedByTheirLike) {
  EXPECT_THAT(refusal("\nx = [}\n"), StartsWith("f.toml:2: "));
  EXPECT_THAT(refusal("\nx = [1, { a = [2 } ]\n"), StartsWith("f.toml:2: "));
  EXPECT_EQ(refusal("x = [{ a = ['}', [1]] }, {}] # [}\n"), "accepted");
}

TEST(TomlTextTest, DotsOfTextsAndCommentsAreNotThoseOfKeys) {
  const std::string dots(200, '.');
  EXPECT_EQ(refusal("# " + dots + "\na = '" + dots + "' # " + dots + "\n"), "accepted");
}

TEST(TomlTextTest, ATextInPlaceOfANumberMayHoldAnyLetter) {
  Table table = Table::parse("x = \"3é\"\n", "f.toml");
  table.number("x", {}, "");
  EXPECT_THROW(table.finish(), InputError);
}

TEST(TomlTextTest, NothingElseCallsTheParser) {
  namespace fs = std::filesystem;
  const fs::path root = HAPTRIAL_SOURCE_DIR;
  int files = 0;
  for (const char* folder : {"core", "protocols", "experiments", "analysis"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() == ".cpp" && file.filename() != "toml_text.cpp") {
        ++files;
        EXPECT_EQ(file_text(file).find("toml::parse"), std::string::npos) << file;
      }
    }
  }
  EXPECT_GT(files, 500);
}

}  // namespace
}  // namespace haptrial::toml_text_test
