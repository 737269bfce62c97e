// Mistakes that people make in definitions: each is reported in its own line and in plain words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/definition/table.h"
#include "core/base/definition/toml_mistake_internal.h"
#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::toml_mistake_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The sentence with which a text is refused.
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
  unsigned line;
  const char* sentence;
};

TEST(TomlMistakeTest, EachIsReportedInItsLineAndSaysWhatToWrite) {
  for (const Mistake& m : std::vector<Mistake>{
           // Brackets, braces and quotes that are not closed: the line in which they open.
           {"a = 1\nlist = [1, 2\nb = 3\nc = 4\n", 2,
            "the array that begins here has no closing bracket; write ] at its end"},
           {"a = 1\nlist = [\n  1,\n  2,\n\n[next]\nc = 4\n", 2,
            "the array that begins here has no closing bracket; write ] at its end"},
           {"list = [\n  \"a\", # one\n  \"b\"\n# more\nb = 2\n", 1, "has no closing bracket"},
           {"list = [[1, 2], [3, 4]\nb = 2\n", 1, "has no closing bracket"},
           {"a = 1\nlist = [1, 2", 2, "has no closing bracket"},
           {"a = 1\n[trajectory\nspeed = 1\n", 2,
            "the table header [trajectory has no closing ]; write [trajectory]"},
           {"[[many]\nspeed = 1\n", 1, "the table header [[many has no closing ]]"},
           {"a = 1\nb = { x = 1, y = 2\nc = 3\n", 2,
            "the table that begins with { here has no closing brace; write } at its end, in the "
            "same line"},
           {"b = {\n x = 1 }\n", 1, "has no closing brace"},
           {"a = 1\nname = \"arm\nb = 2\n", 2,
            "the text \"arm has no closing quote; write \" at its end"},
           {"a = 1\ntext = \"Hold on.\nFollow = the line\nb = 2\n", 2,
            "the text \"Hold on. has no closing quote"},
           {"a = 1\ntext = \"Hold on.\n\nFollow it.\"\nb = 2\n", 2,
            "a text of several lines needs \"\"\" at both ends"},
           {"list = [\"a,\n  \"b\"]\n", 1, "the text \"a, has no closing quote"},
           {"name = 'arm\nb = 2\n", 1, "the text 'arm has no closing quote; write ' at its end"},
           {"a = 1\nname = arm\"\n", 2, "the text arm\" has no opening quote"},
           {"a = 1\nb = \"\"\"one\ntwo\n\nc = 2\n", 2, "the text that begins with \"\"\" here"},
           {"list = [\"a, \"b\"]\n", 1, "a comma or a bracket is missing before \"b\"]\""},
           // Values.
           {"a = 1\nspeed =\nb = 2\n", 2, "speed has no value; write speed = VALUE"},
           {"a = 1\nspeed = # fast\n", 2, "speed has no value; write speed = VALUE"},
           {"a = 1\nspeed 1.6\n", 2, "no = follows speed; write speed = VALUE"},
           {"a = 1\nspeed\n", 2, "no = follows speed"},
           {"speed: 1.6\n", 1, "no = follows speed; write speed = VALUE"},
           {"= 3\n", 1, "no key stands before =; write KEY = VALUE"},
           {"max speed = 3\n", 1,
            "\"max speed\" is not a key; a key has no spaces, such as "
            "max_speed"},
           {"r\u00e4nge_z = 3\n", 1,
            "the key r\u00e4nge_z has a character that is not allowed; use letters from a to z, "
            "digits, _ and -"},
           {"\u00e4rm = 3\n", 1, "the key \u00e4rm has a character that is not allowed"},
           {"[r\u00e4nge]\n", 1, "the key r\u00e4nge has a character that is not allowed"},
           {"rate% = 3\n", 1, "the key rate% has a character that is not allowed"},
           {"a = 1\nspeed = 0,5\n", 2, "0,5 has a decimal comma; write 0.5"},
           {"p = { x = -1,25, y = 2 }\n", 1, "-1,25 has a decimal comma; write -1.25"},
           {"a = True\n", 1, "True is not a value; write true"},
           {"a = FALSE\n", 1, "FALSE is not a value; write false"},
           {"a = yes\n", 1, "yes is not a value; write true"},
           {"a = 1\nname = arm\n", 2, "arm is a text without quotes; write \"arm\""},
           {"name = My study # 1\n", 1, "My study is a text without quotes; write \"My study\""},
           {"list = [haptic, visual]\n", 1, "haptic is a text without quotes; write \"haptic\""},
           {"a = .5\n", 1, ".5 is not a number; write 0.5"},
           {"a = -5.\n", 1, "-5. is not a number; write -5.0"},
           {"a = 05\n", 1, "05 begins with a zero; write 5"},
           {"a = 5mm\n", 1, "5mm is not a number; write the number alone, without a unit"},
           {"a = 5 mm\n", 1, "\"mm\" follows the value; delete it, or write # before it"},
           {"a = 5 mm # wide\n", 1, "\"mm\" follows the value"},
           {"a = 12;\n", 1, "12; is not a number; write 12"},
           {"a = 1 b = 2\n", 1, "\"b = 2\" follows the value"},
           {"a = [1, 2]]\n", 1, "\"]\" follows the value"},
           {"a = [1 2]\n", 1, "a comma or a bracket is missing before \"2]\""},
           {"a = [\n  1\n  2\n]\n", 2, "a comma or a bracket is missing before \"2\""},
           {"a = \"C:\\data\"\n", 1, "a backslash in a text in quotes begins an escape"},
           // Given twice: also the line of the first.
           {"a = 1\nb = 2\na = 3\n", 3, "a is given twice; line 1 has it already"},
           {"[t]\nx = 1\n[u]\nx = 1\n[t]\ny = 2\n", 5, "[t] is given twice; line 1 has it already"},
           {"[t]\nx = 1\ny = 2\nx = 3\n", 4, "x is given twice; line 2 has it already"},
           // Characters.
           {"a = 1\nname = \u201carm\u201d\n", 2,
            "\u201c is a typographic quote; write the straight quote \""},
           {"list = [\u2018a\u2019]\n", 1, "\u2018 is a typographic quote"},
           {"a = \u22125\n", 1, "\u2212 is a typographic minus; write the hyphen -"},
           {"a\u00a0= 5\n", 1, "a no-break space stands here; write an ordinary space"},
           {"a = 1\nb = 2\x01\n", 2, "the line holds the control character U+0001; delete it"},
           {"a = 1\nb = \"\xe9\"\n", 2, "bytes that are not UTF-8; save the text as UTF-8"},
           {"\xff\xfe\x61\x01", 1, "the text is UTF-16; save it as UTF-8"},
       }) {
    EXPECT_THAT(refusal(m.text),
                AllOf(StartsWith("f.toml:" + std::to_string(m.line) + ": "), HasSubstr(m.sentence)))
        << m.text;
  }
}

TEST(TomlMistakeTest, WindowsLineEndsTabsAndAByteOrderMarkAreFine) {
  EXPECT_EQ(refusal("\ufeff[t]\r\n\ta\t=\t1\r\nb = [\r\n\t1,\r\n]\r\n"), "accepted");
  EXPECT_THAT(refusal("\ufeff[t]\r\na = 1\r\nb = [1,\r\n2\r\nc = 1\r\n"), StartsWith("f.toml:3: "));
}

std::string shipped(const std::string& name) {
  std::ifstream in(std::string(HAPTRIAL_SOURCE_DIR "/experiments/") + name);
  std::ostringstream whole;
  whole << in.rdbuf();
  return whole.str();
}

constexpr const char* kEveryKindOfValue =
    "title = 'TOML' # a comment\n\"quoted key\" = 1\na.b.c = 2\na.\"b d\" = 3\n"
    "integers = [+99, 42, 0, -17, 1_000, 0xDEADBEEF, 0o755, 0b1101]\n"
    "floats = [+1.0, 3.14, -0.01, 5e+22, 1e06, -2E-2, 6.626e-34, inf, -inf, nan, +nan]\n"
    "truth = [true, false]\nwhen = 1979-05-27T07:32:00Z\nwith_space = 1979-05-27 07:32:00\n"
    "day = 1979-05-27\nhour = 07:32:00.5\nempty = []\nnone = {}\nlong = \"\"\"a \"\"quote\"\" \\\n"
    "  b\"\"\"\"\nraw = '''c:\\d\n[not a table]\nx = 1'''\nescaped = \"tab\\t \\\"q\\\" \\u00e9\"\n"
    "nested = [[1, 2], [\n  'a', # with a comment\n\n  'b',\n], { x = 1, y = [1,2], z.q = 'r' }]\n"
    "[table] # comment\nx = 1\n[table.inner]\nx = 1\n[ spaced . header ]\nx = 1\n"
    "[[list]]\nx = 1\n[list.inner]\ny = 1\n[[list]]\nx = 2\n[list.inner]\ny = 2\n";

TEST(TomlMistakeTest, FindsNothingInWhatIsToml) {
  ASSERT_EQ(refusal(kEveryKindOfValue), "accepted");
  std::vector<std::string> sound{kEveryKindOfValue};
  for (const auto& entry :
       std::filesystem::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    if (entry.path().extension() == ".toml") {
      sound.push_back(shipped(entry.path().filename()));
    }
  }
  ASSERT_GT(sound.size(), 4u);
  for (const std::string& text : sound) {
    const auto mistake = find_toml_mistake(text);
    EXPECT_FALSE(mistake) << mistake->line << ": " << mistake->sentence;
  }
  // Nor in what a change left sound.
  RandomStream random(7, "changes");
  static const std::string kSigns = "[]{}\"'=.,#\n\r\t \\-+_0ea";
  int still_sound = 0;
  int plain = 0, refused = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string text = sound[random.below(sound.size())];
    for (std::uint64_t i = random.below(3); i < 3; ++i) {
      const std::size_t at = random.below(text.size());
      switch (random.below(3)) {
        case 0:
          text.erase(at, random.below(10));
          break;
        case 1:
          text.insert(at, 1, kSigns[random.below(kSigns.size())]);
          break;
        default:
          text[at] = kSigns[random.below(kSigns.size())];
      }
      text += "\n#";
    }
    const auto mistake = find_toml_mistake(text);
    if (refusal(text) == "accepted") {
      ++still_sound;
      ASSERT_FALSE(mistake) << mistake->line << ": " << mistake->sentence << "\n" << text;
    } else {
      ++refused;
      plain += mistake ? 1 : 0;
    }
  }
  EXPECT_GT(still_sound, 500);
  EXPECT_GT(plain, refused * 3 / 4) << "most mistakes are said in plain words";
}

TEST(TomlMistakeTest, ABracketTakenAwayIsMissedInItsLine) {
  const std::string text = shipped("force_training.toml");
  const std::size_t begin = text.find("conditions = [");
  ASSERT_NE(begin, std::string::npos);
  const auto line = static_cast<unsigned>(1 + std::count(text.begin(), text.begin() + begin, '\n'));
  std::string broken = text;
  broken.erase(text.find(']', begin), 1);
  EXPECT_THAT(refusal(broken), StartsWith("f.toml:" + std::to_string(line) + ": the array "));
}

}  // namespace
}  // namespace haptrial::toml_mistake_test
