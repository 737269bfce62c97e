#include "analysis/files/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StrEq;

CsvTable parse(const std::string& text) { return CsvTable::parse(text, "a.csv"); }

std::vector<double> second_column(const std::string& text) { return parse(text).numbers(1); }

template <class Work>
std::string problem_of(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string problem_of_text(const std::string& text) {
  return problem_of([&] { parse(text); });
}

std::string problem_of_numbers(const std::string& text) {
  return problem_of([&] { second_column(text); });
}

TEST(CsvTest, NamesNumbersAndLines) {
  const CsvTable table = parse("time,force\n0,1.5\n0.001,-2e3\n");
  EXPECT_THAT(table.columns(), ElementsAre("time", "force"));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.column("force"), 1u);
  EXPECT_TRUE(table.has("time"));
  EXPECT_FALSE(table.has("Time"));
  EXPECT_THAT(table.numbers(0), ElementsAre(0.0, 0.001));
  EXPECT_THAT(table.numbers(1), ElementsAre(1.5, -2000.0));
  EXPECT_EQ(table.line(1), 3u);
  EXPECT_EQ(table.text(1, 1), "-2e3");
}

TEST(CsvTest, EveryLineEndAndSeparatorReadsTheSame) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    for (const char* separator : {",", ";", "\t", " , ", "; "}) {
      for (bool last : {true, false}) {
        const std::string s = separator, e = end;
        const std::string text = "t" + s + "f" + e + "0" + s + "+1.25" + e + "1" + s + ".5";
        const CsvTable table = parse(last ? text + e + e : text);
        EXPECT_THAT(table.columns(), ElementsAre("t", "f")) << text;
        EXPECT_THAT(table.numbers(1), ElementsAre(1.25, 0.5)) << text;
        EXPECT_EQ(table.line(1), 3u) << text;
      }
    }
  }
}

TEST(CsvTest, ASeparatorOfThousandsIsNoDecimalMark) {
  const std::string german = "t;ms\n0;994\n1;1.304\n2;840\n";
  EXPECT_THAT(problem_of_numbers(german), HasSubstr("a.csv:3: ms is '1.304'; allowed: a number "
                                                    "without a separator of thousands"));
  EXPECT_THAT(problem_of_numbers("t\tms\n0\t994\n1\t1,304\n"), HasSubstr("'1,304'"));
  EXPECT_THAT(second_column("t,f\n0,1.304\n1,994.000\n"), ElementsAre(1.304, 994.0));
  EXPECT_THAT(second_column("t,f\n0,1.304\n1,99\n"), ElementsAre(1.304, 99.0));
  EXPECT_THAT(second_column("t,f\n0,1.304\n1,994\n2,0.5\n"), ElementsAre(1.304, 994.0, 0.5));
  EXPECT_THAT(second_column("t,f\n0,1.304\n1,994\n2,1304\n"), ElementsAre(1.304, 994.0, 1304.0));
}

TEST(CsvTest, DecimalCommaWhereCommasDoNotSeparate) {
  EXPECT_THAT(second_column("t;f\n0;1,5\n1;2\n2;-1,25e2\n"), ElementsAre(1.5, 2.0, -125.0));
  EXPECT_THAT(second_column("t\tf\n0\t1,5\n1\t2,5\n"), ElementsAre(1.5, 2.5));
  EXPECT_THAT(problem_of_numbers("t;f\n0;1,5\n1;2.5\n"),
              StrEq("a.csv:3: f is '2.5'; allowed: a finite number with a decimal comma"));
  EXPECT_THAT(problem_of_numbers("t;f\n0;1.5\n1;2,5\n"), HasSubstr("a.csv:3: f is '2,5'"));
  EXPECT_THAT(problem_of_numbers("t;f\n0;1.234,5\n"), HasSubstr("f is '1.234,5'"));
}

TEST(CsvTest, ColumnsWithoutNamesGoByNumber) {
  const CsvTable table = parse("0,1.5\n0.5,2.5\n");
  EXPECT_THAT(table.columns(), ElementsAre("1", "2"));
  EXPECT_THAT(table.numbers(table.column("2")), ElementsAre(1.5, 2.5));
  EXPECT_EQ(table.line(0), 1u);
  // A missing value in the first row does not make names of it.
  EXPECT_THAT(problem_of_numbers("0,NaN\n1,2\n"), HasSubstr("a.csv:1: 2 is 'NaN'"));
  EXPECT_THAT(parse("0;1,5\n").numbers(1), ElementsAre(1.5));
}

TEST(CsvTest, QuotesHoldAnything) {
  const CsvTable table =
      parse("\"name, of\",\"the \"\"best\"\"\"\n\"a\nb\" , \" c\"\n\"\",d\r\n\"5\",e\n");
  EXPECT_THAT(table.columns(), ElementsAre("name, of", "the \"best\""));
  EXPECT_EQ(table.text(0, 0), "a\nb");
  EXPECT_EQ(table.text(0, 1), " c");
  EXPECT_EQ(table.text(1, 0), "");
  EXPECT_EQ(table.line(0), 2u);
  EXPECT_EQ(table.line(1), 4u) << "a quoted field that spans lines counts them";
  EXPECT_THAT(problem_of_text("a,b\n1,\"2\n3,4\n"), HasSubstr("a.csv:2: a quote is opened"));
  EXPECT_THAT(problem_of_text("a,b\n1,\"2\"x\n"), HasSubstr("a.csv:2: text follows"));
  EXPECT_EQ(parse("name\n\"\"\n\"\"\n").rows(), 2u) << "quoted, so not an empty line";
}

TEST(CsvTest, ByteOrderMarkAndCommentsComeBeforeTheFirstRow) {
  const CsvTable table = parse("\xef\xbb\xbf# recorded today, see notes\n\n# 1000 Hz\nt,f\n1,2\n");
  EXPECT_THAT(table.columns(), ElementsAre("t", "f"));
  EXPECT_EQ(table.line(0), 5u);
}

TEST(CsvTest, EveryBadTextGetsASentence) {
  EXPECT_EQ(problem_of_text(""), "a.csv: holds no rows of values; allowed: at least one");
  EXPECT_THAT(problem_of_text("\n\n"), HasSubstr("holds no rows"));
  EXPECT_THAT(problem_of_text("t,f\n"), HasSubstr("holds no rows"));
  EXPECT_EQ(problem_of_text("t,f\n1,2\n3\n"),
            "a.csv:3: the row has 1 fields; allowed: 2, as in line 1");
  EXPECT_THAT(problem_of_text("t,f\n1,2,\n"), HasSubstr("a.csv:2: the row has 3 fields"));
  EXPECT_EQ(problem_of_text("f\n1\n\n2\n"), "a.csv:3: the line is empty; delete it");
  EXPECT_THAT(problem_of_text(std::string("t\0f\n", 4)), HasSubstr("holds zero bytes"));
}

TEST(CsvTest, EveryBadNumberGetsASentence) {
  for (const char* bad : {"", "nan", "NaN", "NA", "inf", "-inf", "1.5 N", "1e999", "0x10", "1 000",
                          "--1", "+-1", "+", "1.5.2", "one", "1_0", "٣"}) {
    EXPECT_EQ(problem_of_numbers("t,f\n0,1\n1," + std::string(bad) + "\n"),
              "a.csv:3: f is '" + std::string(bad) + "'; allowed: a finite number");
  }
  EXPECT_THAT(problem_of_numbers("t,f\n1," + std::string(500, 'x') + "\n"),
              HasSubstr("f is '" + std::string(40, 'x') + "...'"));
}

TEST(CsvTest, ColumnsThatAreNotThere) {
  const CsvTable table = parse("t,f,f\n1,2,3\n");
  EXPECT_EQ(problem_of([&] { table.column("force"); }),
            "a.csv: there is no column 'force'; allowed: t, f, f");
  EXPECT_THAT(problem_of([&] { table.column("f"); }), HasSubstr("several columns are named"));
}

TEST(CsvTest, Files) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(problem_of([&] { CsvTable::load(folder / "absent.csv"); }),
              HasSubstr("no such file"));
  EXPECT_THAT(problem_of([&] { CsvTable::load(folder.path()); }), HasSubstr("is a directory"));
  std::ofstream(folder / "a.csv") << "t,f\n1,2\n";
  EXPECT_THAT(CsvTable::load(folder / "a.csv").numbers(1), ElementsAre(2.0));
  std::ofstream(folder / "empty.csv").flush();
  EXPECT_THAT(problem_of([&] { CsvTable::load(folder / "empty.csv"); }),
              HasSubstr((folder / "empty.csv").string() + ": holds no rows"));
}

/// Whatever the bytes, a table or a sentence comes back.
TEST(CsvTest, RandomBytesNeverBreakIt) {
  RandomStream random(1, "csv");
  const std::string letters = "0123456789.,;\t\"\n\r# aN-+e\xef\xbb\xbf";
  int tables = 0;
  for (int n = 0; n < 20000; ++n) {
    std::string text;
    for (std::uint64_t k = random.below(40); k > 0; --k) {
      text += letters[random.below(letters.size())];
    }
    try {
      const CsvTable table = parse(text);
      ++tables;
      for (std::size_t c = 0; c < table.columns().size(); ++c) {
        ASSERT_LE(table.text(table.rows() - 1, c).size(), text.size());
        problem_of([&] { table.numbers(c); });
      }
    } catch (const InputError& error) {
      ASSERT_THAT(error.what(), HasSubstr("; "));
    }
  }
  EXPECT_GT(tables, 1000);
}

}  // namespace
}  // namespace haptrial::analysis
