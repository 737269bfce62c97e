// A text that is not TOML is refused with its line and column; what would reach undefined behaviour
// of the parser is refused before it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

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

struct Mistake {
  const char* text;
  const char* place;  // line and column, counted by hand
  const char* problem;
};

TEST(TomlTextTest, AMistakeIsPlacedAndNamed) {
  for (const Mistake& m : std::vector<Mistake>{
           {"a = 1\nspeed =\nb = 2\n", "2:8", "expected value"},
           {"a = 1\nspeed 1.6\n", "2:7", "expected '='"},
           {"a = 1\nname = arm\"\n", "2:8", "write a text in quotes"},
           {"a = 1\nspeed = 0,5\n", "2:10", "expected a comment or whitespace, saw ','"},
           {"a = 5 mm\n", "1:7", "saw 'm'"},
           {"a = [1 2]\n", "1:8", "expected comma or closing ']'"},
           {"a = 1\nlist = [1, 2\nb = 3\n", "3:1", "expected comma or closing ']'"},
           {"a = 1\n[trajectory\nspeed = 1\n", "2:12", "table header: expected ']'"},
           {"a = \"C:\\data\"\n", "1:9", "unknown escape sequence"},
           {"a = 1\nb = 2\na = 3\n", "3:5", "redefine existing integer 'a'"},
           {"[t]\nx = 1\n[u]\nx = 1\n[t]\ny = 2\n", "5:1", "redefine existing table 't'"},
           {"\ufeff[t]\r\na = 1\r\nb = \r\n", "3:5", "expected value"},
           {"x = 'é' é\n", "1:9", "é stands outside of quotes"},
           {"\ufeffx = 'é' é\n", "1:9", "é stands outside of quotes"},
           {"a = 1\nb = \xe9\n", "2:5", "not UTF-8; save the text as UTF-8"},
           {"\xff\xfe\x61\x01", "1:1", "not UTF-8; save the text as UTF-8"},
       }) {
    EXPECT_THAT(refusal(m.text), AllOf(StartsWith(std::string("f.toml:") + m.place + ": "),
                                       HasSubstr("not valid TOML: "), HasSubstr(m.problem)))
        << m.text;
  }
}

TEST(TomlTextTest, WindowsLineEndsTabsAndAByteOrderMarkAreFine) {
  EXPECT_EQ(refusal("\ufeff[t]\r\n\ta\t=\t1\r\nb = [\r\n\t1,\r\n]\r\n"), "accepted");
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
                  AllOf(StartsWith("f.toml:2:"), HasSubstr(letter)))
          << line;
    }
  }
}

TEST(TomlTextTest, AValueThatIsALetterSaysWhatIsAllowed) {
  EXPECT_EQ(refusal("x = ×\n"),
            "f.toml:1:5: not valid TOML: × stands outside of quotes; write a text in quotes, and a "
            "key with letters "
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
    EXPECT_THAT(refusal("a = [\n  [1],\n]\n" + std::string(line) + "\n"), StartsWith("f.toml:4:"))
        << line;
  }
  EXPECT_EQ(refusal("a = [\n[ 1 ], # [\n[-1],\n]\n [ \"b\" ]\n[[ 'c' ]]\n"), "accepted");
}

TEST(TomlTextTest, BracketsAreClosedByTheirLike) {
  EXPECT_THAT(refusal("\nx = [}\n"), StartsWith("f.toml:2:"));
  EXPECT_THAT(refusal("\nx = [1, { a = [2 } ]\n"), StartsWith("f.toml:2:"));
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
