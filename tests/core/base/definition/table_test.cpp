#include "core/base/definition/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "core/base/error.h"

namespace haptrial::table_test {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The sentences with which the document is refused after `read`; none when it is accepted.
std::vector<std::string> problems(const std::string& text,
                                  const std::function<void(Table&)>& read) {
  try {
    Table document = Table::parse(text, "f.toml");
    read(document);
    document.finish();
  } catch (const InputError& error) {
    std::vector<std::string> lines;
    std::istringstream in(error.what());
    for (std::string line; std::getline(in, line);) {
      lines.push_back(line);
    }
    return lines;
  }
  return {};
}

void read_nothing(Table&) {}

TEST(TablePartsTest, SentencesNameEachFileWithItsLines) {
  Table t = Table::parse(std::vector<NamedText>{{"[a]\nx = 1\n", "first.toml"},
                                                {"\n[b]\ny = -1\n", "second.toml"},
                                                {"[c]\nz = -1\n", "third.toml"}});
  EXPECT_EQ(t.source(), "[a]\nx = 1\n\n[b]\ny = -1\n[c]\nz = -1\n");
  t.table("a").number("x", {2.0, 3.0}, "");
  t.table("b").number("y", kPositive, "");
  t.table("c").number("z", kPositive, "");
  t.table("d");
  try {
    t.finish();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("first.toml:2: a.x is 1"));
    EXPECT_THAT(error.what(), HasSubstr("second.toml:3: b.y is -1"));
    EXPECT_THAT(error.what(), HasSubstr("third.toml:2: c.z is -1"));
    EXPECT_THAT(error.what(), HasSubstr("the table [d] is missing"));
  }
}

TEST(TableTest, GoodValuesOfEveryTypeComeBack) {
  Table t = Table::parse(
      "x = 1.5\nwhole = 3\nn = -7\nyes = true\nname = \"arm\"\nkind = \"b\"\n"
      "list = [1, 2.5]\nwords = [\"p\", \"q\"]\n[inner]\ny = 2e-3\n",
      "f.toml");
  EXPECT_EQ(t.number("x", kPositive, "m"), 1.5);
  EXPECT_EQ(t.number("whole", kPositive, "m"), 3.0) << "an integer is a number too";
  EXPECT_EQ(t.integer("n", -7, 0), -7);
  EXPECT_TRUE(t.boolean("yes"));
  EXPECT_EQ(t.text("name"), "arm");
  EXPECT_EQ(t.choice("kind", {"a", "b"}), "b");
  EXPECT_THAT(t.numbers("list", kPositive, "N"), ElementsAre(1.0, 2.5));
  EXPECT_THAT(t.texts("words"), ElementsAre("p", "q"));
  EXPECT_EQ(t.table("inner").number("y", kPositive, "s"), 0.002);
  EXPECT_NO_THROW(t.finish());
}

TEST(TableTest, TablesOfAnArrayAreReadInTheirOrder) {
  const auto read = [](Table& t) {
    for (Table& each : t.tables("stages")) {
      each.text("name");
      each.number("time", kPositive, "s");
    }
  };
  Table t = Table::parse("[[stages]]\nname = \"a\"\n[[stages]]\nname = \"b\"\n", "f.toml");
  std::vector<Table> stages = t.tables("stages");
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[1].text("name"), "b");
  EXPECT_THAT(
      problems("[[stages]]\nname = \"a\"\ntime = 1\n[[stages]]\nname = \"b\"\ntime = -1\n", read),
      ElementsAre("f.toml:6: stages[2].time is -1; allowed: a number above 0 [s]"));
  EXPECT_THAT(problems("[a]\n", read),
              testing::Contains(HasSubstr("the tables [[stages]] are missing")));
  EXPECT_THAT(problems("stages = 3\n", read), ElementsAre(HasSubstr("stages is 3; allowed:")));
  EXPECT_THAT(problems("[[stages]]\nname = \"a\"\ntime = 1\ntme = 2\n", read),
              ElementsAre(HasSubstr("stages[1].tme is not a known key")));
  EXPECT_TRUE(t.is_array("stages"));
  EXPECT_FALSE(t.is_array("stage"));
  const Table either = Table::parse("a = { median = 1 }\nb = 0.5\n", "either.toml");
  EXPECT_TRUE(either.is_table("a"));
  EXPECT_FALSE(either.is_table("b"));
  EXPECT_FALSE(either.is_table("c"));
}

TEST(TableTest, TellsWhatItHolds) {
  const std::string text = "b = 1 # kept\na = 2\n";
  const Table t = Table::parse(text, "f.toml");
  EXPECT_EQ(t.source(), text);
  EXPECT_THAT(t.keys(), ElementsAre("a", "b"));
  EXPECT_TRUE(t.has("a"));
  EXPECT_FALSE(t.has("c"));
}

TEST(TableTest, EveryProblemNamesLineKeyFoundAndAllowed) {
  const auto found = problems(
      "speed = -1.6\ncount = 2.0\nflag = 1\nname = \"\"\nkind = \"z\"\nlist = [1, -2]\n"
      "words = [\"p\", 3]\nnone = []\nextra = 1\n",
      [](Table& t) {
        t.number("speed", kPositive, "m/s");
        t.integer("count", 1, 9);
        t.boolean("flag");
        t.text("name");
        t.choice("kind", {"a", "b"});
        t.numbers("list", kNonNegative, "N");
        t.texts("words");
        t.texts("none");
      });
  EXPECT_THAT(
      found,
      ElementsAre("f.toml:1: speed is -1.6; allowed: a number above 0 [m/s]",
                  "f.toml:2: count is 2.0; write it without a decimal point: count = 2",
                  "f.toml:3: flag is 1; allowed: true or false",
                  "f.toml:4: name is an empty text; allowed: a text in quotes that is not empty",
                  "f.toml:5: kind is 'z'; allowed: a, b",
                  "f.toml:6: list is an array with -2; allowed: an array, each a number of at "
                  "least 0 [N]",
                  "f.toml:7: words is an array with 3; allowed: an array of texts in quotes",
                  "f.toml:8: none is an empty array; allowed: an array of texts in quotes",
                  "f.toml:9: extra is not a known key; known here: count, flag, kind, list, "
                  "name, none, speed, words"));
}

TEST(TableTest, ProblemsComeInTheOrderOfLinesWhateverTheOrderOfReading) {
  const auto found = problems("a = -1\nb = -1\nc = -1\n[t]\nd = -1\n", [](Table& t) {
    Table inner = t.table("t");
    inner.number("d", kPositive, "");
    for (const char* key : {"c", "a", "b"}) {
      t.number(key, kPositive, "");
    }
  });
  EXPECT_THAT(found, ElementsAre(StartsWith("f.toml:1: a "), StartsWith("f.toml:2: b "),
                                 StartsWith("f.toml:3: c "), StartsWith("f.toml:5: t.d ")));
}

TEST(TableTest, WrongTypesAreRefusedForEveryReader) {
  const std::map<std::string, std::function<void(Table&)>> readers{
      {"number", [](Table& t) { t.number("k", {}, ""); }},
      {"integer", [](Table& t) { t.integer("k", -9, 9); }},
      {"boolean", [](Table& t) { t.boolean("k"); }},
      {"text", [](Table& t) { t.text("k"); }},
      {"choice", [](Table& t) { t.choice("k", {"w"}); }},
      {"numbers", [](Table& t) { t.numbers("k", {}, ""); }},
      {"texts", [](Table& t) { t.texts("k"); }},
      {"table", [](Table& t) { t.table("k"); }}};
  const std::map<std::string, std::vector<std::string>> accepted{{"1.5", {"number"}},
                                                                 {"3", {"number", "integer"}},
                                                                 {"true", {"boolean"}},
                                                                 {"\"w\"", {"text", "choice"}},
                                                                 {"[1.0, 2]", {"numbers"}},
                                                                 {"[\"w\"]", {"texts"}},
                                                                 {"[true]", {}},
                                                                 {"{}", {"table"}},
                                                                 {"1979-05-27", {}},
                                                                 {"07:32:00", {}},
                                                                 {"1979-05-27T07:32:00Z", {}},
                                                                 {"[1979-05-27]", {}},
                                                                 {"[[1.0]]", {}},
                                                                 {"nan", {}},
                                                                 {"-inf", {}},
                                                                 {"[1.0, nan]", {}},
                                                                 {"9223372036854775807", {}}};
  for (const auto& [value, good] : accepted) {
    for (const auto& [name, read] : readers) {
      const auto found = problems("k = " + value + "\n", read);
      if (std::count(good.begin(), good.end(), name)) {
        EXPECT_TRUE(found.empty()) << name << " of " << value << ": " << found.front();
      } else {
        ASSERT_FALSE(found.empty()) << name << " of " << value;
        EXPECT_THAT(found[0], StartsWith("f.toml:1: k is ")) << name << " of " << value;
        EXPECT_THAT(found[0], AnyOf(HasSubstr("; allowed: "), HasSubstr("; write it ")));
      }
    }
  }
}

TEST(TableTest, BoundsAreInclusiveUnlessOpen) {
  const auto accepted = [](const std::string& value, const Bounds& bounds) {
    return problems("k = " + value + "\n", [&](Table& t) { t.number("k", bounds, ""); }).empty();
  };
  EXPECT_TRUE(accepted("0.0", kFraction));
  EXPECT_TRUE(accepted("1.0", kFraction));
  EXPECT_FALSE(accepted("-5e-324", kFraction));
  EXPECT_FALSE(accepted("1.0000000000000002", kFraction));
  EXPECT_FALSE(accepted("0.0", kPositive));
  EXPECT_FALSE(accepted("-0.0", kPositive));
  EXPECT_TRUE(accepted("5e-324", kPositive));
  EXPECT_TRUE(accepted("0", kNonNegative));
  EXPECT_TRUE(accepted("-1e308", {}));
}

TEST(TableTest, BoundsAreSaidInWords) {
  const auto words = [](const Bounds& bounds) {
    const auto found = problems("k = nan\n", [&](Table& t) { t.number("k", bounds, "N"); });
    return found.front().substr(found.front().find("allowed: ") + 9);
  };
  EXPECT_EQ(words({}), "a finite number [N]");
  EXPECT_EQ(words(kPositive), "a number above 0 [N]");
  EXPECT_EQ(words(kNonNegative), "a number of at least 0 [N]");
  EXPECT_EQ(words(kFraction), "a number of at least 0 and at most 1 [N]");
  EXPECT_EQ(words({0.0, 2.0, true}), "a number above 0 and at most 2 [N]");
  EXPECT_EQ(words({-HUGE_VAL, 5.0, false}), "a number of at most 5 [N]");
}

TEST(TableTest, ARefusedNumberReadsAsTheSmallestAllowedOne) {
  Table t = Table::parse("k = nan\n", "f.toml");
  EXPECT_EQ(t.number("k", {2.0, 5.0}, ""), 2.0);
  EXPECT_EQ(t.number("absent", {2.0, 5.0}, ""), 2.0);
  const double above = t.number("k", {2.0, 5.0, true}, "");
  EXPECT_GT(above, 2.0);
  EXPECT_LT(above, 2.0 + 1e-12);
  EXPECT_EQ(t.integer("k", -3, 3), -3);
  EXPECT_EQ(t.choice("k", {"a", "b"}), "a");
}

TEST(TableTest, ABoundThatDependsOnARefusedValueMakesNoSecondProblem) {
  const auto found = problems("low = -1\nhigh = 3.0\n", [](Table& t) {
    const double low = t.number("low", {0.0, 100.0, true}, "");
    t.number("high", {low, 100.0}, "");
  });
  EXPECT_EQ(found.size(), 1u);
}

TEST(TableTest, AMissingTableIsOneProblem) {
  const auto found = problems("a = 1\n", [](Table& t) {
    t.number("a", kPositive, "");
    Table gains = t.table("gains");
    EXPECT_EQ(gains.number("k", kPositive, ""), std::nextafter(0.0, 1.0));
    EXPECT_TRUE(gains.numbers("list", kPositive, "").empty());
    EXPECT_TRUE(gains.texts("list").empty());
    EXPECT_TRUE(gains.keys().empty());
    EXPECT_FALSE(gains.has("k"));
    gains.table("inner").text("name");
    gains.reject("k", "too small", "more");
    t.table("gains");  // asked for again
  });
  EXPECT_THAT(found, ElementsAre("f.toml:1: the table [gains] is missing"));
}

TEST(TableTest, UnknownKeysAreFoundInEveryTableThatWasRead) {
  const auto found = problems("[t]\nx = 1\nspare = 2\n[t.u]\ny = { z = 1, w = 2 }\nv.q = 1\n",
                              [](Table& document) {
                                Table t = document.table("t");
                                t.number("x", kPositive, "");
                                t.table("u").table("y").number("z", kPositive, "");
                              });
  EXPECT_THAT(found, ElementsAre("f.toml:3: t.spare is not a known key; known here: u, x",
                                 "f.toml:5: t.u.y.w is not a known key; known here: z",
                                 "f.toml:6: [t.u.v] is not a known table; known here: y"));
}

TEST(TableTest, AnUnknownKeyNamesTheNearestAndEveryKnownOne) {
  const auto read = [](Table& document) {
    Table t = document.table("trajectory");
    t.number("speed", kPositive, "m/s");
    if (t.has("blend")) {
      t.number("blend", kPositive, "s");
    }
    if (document.has("mouse")) {
      document.table("mouse");
    }
  };
  EXPECT_THAT(problems("[trajectory]\nspeed = 1\nblned = 2\n", read),
              ElementsAre("f.toml:3: trajectory.blned is not a known key; did you mean blend? "
                          "known here: blend, speed"));
  EXPECT_THAT(problems("[trajectory]\nspeed = 1\ncolour = 2\n", read),
              ElementsAre("f.toml:3: trajectory.colour is not a known key; known here: blend, "
                          "speed"));
  EXPECT_THAT(problems("[trajectory]\nspeed = 1\n[muose]\n", read),
              ElementsAre("f.toml:3: [muose] is not a known table; did you mean mouse? known here: "
                          "mouse, trajectory"));
}

TEST(TableTest, AKeyThatIsThereIsNotWhatATypoMeant) {
  EXPECT_THAT(
      problems("speed = 1\nspeeds = 2\n", [](Table& t) { t.number("speed", kPositive, ""); }),
      ElementsAre("f.toml:2: speeds is not a known key; known here: speed"));
}

TEST(TableTest, AValueOfAChoiceNamesTheNearestOne) {
  const auto read = [](Table& t) { t.choice("kind", {"trajectory", "curve"}); };
  EXPECT_THAT(problems("kind = \"crve\"\n", read),
              ElementsAre("f.toml:1: kind is 'crve'; did you mean curve? allowed: trajectory, "
                          "curve"));
  EXPECT_THAT(problems("kind = \"line\"\n", read),
              ElementsAre("f.toml:1: kind is 'line'; allowed: trajectory, curve"));
  EXPECT_THAT(problems("kind = 3\n", read),
              ElementsAre("f.toml:1: kind is 3; allowed: trajectory, curve"));
}

TEST(TableTest, AChoiceAmongNothingIsRefused) {
  EXPECT_THAT(problems("kind = \"line\"\n", [](Table& t) { EXPECT_EQ(t.choice("kind", {}), ""); }),
              ElementsAre("f.toml:1: kind is 'line'; allowed: no value; leave it out"));
}

TEST(TableTest, AValueInQuotesThatShouldHaveNoneIsSaidToBeSo) {
  const auto found = problems(
      "rate = \"1000\"\nrange = \"0.05\"\nfull = \"true\"\nname = 5\nlist = [1, \"2\"]\n"
      "words = \"haptic\"\none = 2.5\ncount = \"many\"\nwhole = 3.0\n",
      [](Table& t) {
        t.integer("rate", 1, 20000);
        t.number("range", kPositive, "m");
        t.boolean("full");
        t.text("name");
        t.numbers("list", kPositive, "N");
        t.texts("words");
        t.numbers("one", kPositive, "N");
        t.integer("count", 1, 9);
        t.integer("whole", 1, 9);
      });
  EXPECT_THAT(
      found,
      ElementsAre("f.toml:1: rate is the text \"1000\"; write it without quotes: rate = 1000",
                  "f.toml:2: range is the text \"0.05\"; write it without quotes: range = 0.05",
                  "f.toml:3: full is the text \"true\"; write it without quotes: full = true",
                  "f.toml:4: name is 5; write it in quotes: name = \"5\"",
                  "f.toml:5: list is an array with the text \"2\"; allowed: an array, each a "
                  "number above 0 [N]",
                  "f.toml:6: words is the text \"haptic\"; write it in brackets: words = "
                  "['haptic']",
                  "f.toml:7: one is 2.5; write it in brackets: one = [2.5]",
                  "f.toml:8: count is 'many'; allowed: a whole number from 1 to 9",
                  "f.toml:9: whole is 3.0; write it without a decimal point: whole = 3"));
}

TEST(TableTest, AProblemOnWhichOthersDependIsReportedAlone) {
  Table t = Table::parse("protocol = \"none\"\nother = 1\n", "f.toml");
  t.choice("protocol", {"a", "b"});
  try {
    t.check();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f.toml:1: protocol is 'none'; allowed: a, b");
  }
  Table good = Table::parse("protocol = \"a\"\nother = 1\n", "f.toml");
  good.choice("protocol", {"a", "b"});
  EXPECT_NO_THROW(good.check()) << "unknown keys are finish()'s";
}

TEST(TableTest, AMisspelledKeyIsFoundBeforeOthersAreRead) {
  Table t = Table::parse("protocl = 1\nrate = 2\n", "f.toml");
  EXPECT_FALSE(t.misspelled("rate"));
  EXPECT_FALSE(t.misspelled("name"));
  EXPECT_TRUE(t.misspelled("protocol"));
  EXPECT_THROW(t.check(), InputError);
}

TEST(TableTest, AProblemMayBeSaidWithoutAllowedValues) {
  EXPECT_THAT(problems("[t]\nx = 1\n",
                       [](Table& document) {
                         Table t = document.table("t");
                         t.number("x", kPositive, "");
                         t.reject("x", "is given without y; add y");
                       }),
              ElementsAre("f.toml:2: t.x is given without y; add y"));
}

TEST(TableTest, ATableReadInTwoPlacesKnowsTheKeysOfBoth) {
  const auto read = [](Table& document) {
    document.table("t").number("a", kPositive, "");
    document.table("t").number("b", kPositive, "");
  };
  EXPECT_TRUE(problems("[t]\na = 1\nb = 2\n", read).empty());
  EXPECT_THAT(problems("[t]\na = 1\nb = 2\nc = 3\n", read),
              ElementsAre("f.toml:4: t.c is not a known key; known here: a, b"));
}

TEST(TableTest, ValuesTakenTogetherAreJudgedOnlyWhereEachIsGood) {
  const auto read = [](Table& document) {
    Table t = document.table("t");
    const double low = t.number("low", kPositive, "");
    if (const double high = t.number("high", kPositive, ""); high < low) {
      t.reject("high", "below low", "at least low");
    }
  };
  EXPECT_THAT(problems("[t]\nlow = 2\nhigh = 1\n", read),
              ElementsAre("f.toml:3: t.high is below low; allowed: at least low"));
  EXPECT_THAT(problems("[t]\nlow = 2\n", read),
              ElementsAre("f.toml:1: t.high is missing; allowed: a number above 0"));
  EXPECT_TRUE(problems("[t]\nlow = 1\nhigh = 2\n", read).empty());
}

TEST(TableTest, ASentenceStaysOneShortReadableLine) {
  std::string umlauts;
  for (int i = 0; i < 60; ++i) {
    umlauts += "ä";
  }
  const auto found = problems(
      "a = \"\"\"one\ntwo\"\"\"\nb = \"\\u001b[31m\"\nc = \"" + umlauts + "\"\n\"x\\ny\" = 1\n",
      [](Table& t) {
        t.number("a", kPositive, "");
        t.choice("b", {"plain"});
        t.choice("c", {"plain"});
      });
  ASSERT_EQ(found.size(), 4u);
  for (const std::string& sentence : found) {
    EXPECT_LT(sentence.size(), 120u);
    EXPECT_EQ(
        std::count_if(sentence.begin(), sentence.end(), [](char c) { return c >= 0 && c < ' '; }),
        0)
        << sentence;
  }
  const auto half = found[2].find("\xc3.");  // the first byte of a character and not the second
  EXPECT_EQ(half, std::string::npos) << found[2];
}

/// The one sentence with which a text is refused before anything is read from it.
std::string refusal(const std::string& text) {
  const auto found = problems(text, read_nothing);
  EXPECT_EQ(found.size(), 1u);
  return found.empty() ? "" : found.front();
}

TEST(TableTest, WhatIsNotADefinitionIsRefusedWithItsLine) {
  EXPECT_THAT(refusal(""), StartsWith("f.toml: the definition is empty; write "));
  EXPECT_THAT(refusal("# a comment\n\n  # another\n"), HasSubstr("the definition is empty"));
  EXPECT_THAT(refusal("a = 1\nb = \n"), StartsWith("f.toml:2:5: not valid TOML: "));
  EXPECT_THAT(refusal("a = 1\na = 2\n"), StartsWith("f.toml:2:5: not valid TOML: "));
  EXPECT_THAT(refusal("a = \"\xff\xfe\"\n"), HasSubstr("invalid utf-8"));
  EXPECT_THAT(refusal(std::string("a = 1\n\0\0b", 9)), StartsWith("f.toml:2:1: not valid TOML"));
  EXPECT_THAT(refusal("\x89PNG\r\n\x1a\n\x01\x02"),
              StartsWith("f.toml:1:1: not valid TOML: the line holds bytes that are not UTF-8"));
}

TEST(TableTest, DeepNestingIsRefusedAndNotFollowed) {
  EXPECT_THAT(refusal("a = " + std::string(100000, '[')), HasSubstr(": not valid TOML"));
  std::string braces = "a = ";
  std::string dots = "\n";
  for (int i = 0; i < 200000; ++i) {
    braces += "{b=";
    dots += "b.";
  }
  EXPECT_THAT(refusal(braces), HasSubstr(": not valid TOML"));
  EXPECT_THAT(refusal(dots + "b = 1\n"), HasSubstr("the line has more than 100 dots"));
  EXPECT_THAT(refusal("\n[" + dots.substr(1) + "b]\n"), StartsWith("f.toml:2:"));
  std::string quoted;
  for (int i = 0; i < 200000; ++i) {
    quoted += i % 2 == 0 ? "\"\\\",\"." : "','.";
  }
  EXPECT_THAT(refusal(quoted + "b = 1\n"), StartsWith("f.toml:1:"));
}

TEST(TableTest, AListOfDecimalsMayBeLong) {
  std::string line = "a = [0.5";
  for (int i = 0; i < 1000; ++i) {
    line += ", 1.5";
  }
  EXPECT_TRUE(Table::parse(line + "]\n", "f.toml").has("a"));
}

class TableFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("haptrial_table_test_" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path file(const std::string& text) const {
    std::ofstream(folder_ / "d.toml", std::ios::binary) << text;
    return folder_ / "d.toml";
  }
  static std::string refusal(const std::filesystem::path& path) {
    try {
      Table::load(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::filesystem::path folder_;
};

TEST_F(TableFileTest, AFileReadsAsItsText) {
  Table t = Table::load(file("a = 1\r\nb = 2\r\n"));
  EXPECT_EQ(t.integer("a", 0, 9), 1);
  EXPECT_EQ(t.source(), "a = 1\r\nb = 2\r\n");
  EXPECT_THROW(t.finish(), InputError);
}

TEST(TableTest, ADocumentIsReadAgainWithoutWhatWasNotedBefore) {
  Table first = Table::parse("a = 1\n[b]\nc = 20\n", "f.toml");
  first.fill_in("[b]\nd = 4\n");
  EXPECT_THROW(first.finish(), InputError);
  EXPECT_EQ(first.table("b").integer("c", 0, 9), 0);
  EXPECT_THROW(first.check(), InputError);

  Table more = first.unread();
  more.fill_in("[b]\nd = 4\ne = 6\n");
  EXPECT_EQ(more.table("b").integer("d", 0, 9), 4);
  EXPECT_EQ(more.table("b").integer("e", 0, 9), 6);

  Table again = first.unread();
  EXPECT_FALSE(again.table("b").has("e"));
  EXPECT_EQ(again.integer("a", 0, 9), 1);
  EXPECT_NO_THROW(again.check());
  Table b = again.table("b");
  EXPECT_EQ(b.integer("d", 0, 9), 4);
  b.integer("c", 0, 9);
  try {
    again.finish();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f.toml:3: b.c is 20; allowed: a whole number from 0 to 9");
  }
}

TEST_F(TableFileTest, WhatCannotBeADefinitionIsRefusedByName) {
  const std::string absent = (folder_ / "absent.toml").string();
  EXPECT_EQ(refusal(absent), absent + ": no such file; give the name of a definition (.toml)");
  EXPECT_THAT(refusal(folder_), HasSubstr("is a directory; give the name of a definition"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("is not a regular file"));
  EXPECT_THAT(refusal(""), HasSubstr("no such file"));
  EXPECT_THAT(refusal(file("")), HasSubstr("the definition is empty"));
  EXPECT_THAT(refusal(file("# " + std::string(2 << 20, 'x'))),
              HasSubstr("has 2097154 bytes; allowed: at most"));
  EXPECT_THAT(refusal(file("a = 1\nb = oops\n")), HasSubstr("d.toml:2:5: not valid TOML: "));
}

}  // namespace
}  // namespace haptrial::table_test
