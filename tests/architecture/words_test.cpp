// Sentences for people: "allowed:" stands before a value, range, list or form; other sentences say
// what to do. Words that readers stumbled over stay out.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::vector<std::regex> kStumblingBlocks = [] {
  std::vector<std::regex> blocks;
  for (const char* words :
       {"allowed: (exactly |only |one of|one or|each |at least one voxel|a new |a folder|the "
        "folder)",
        "allowed: (what |two,|any other|another |from 1 to an hour|a session|a whole "
        "file|undamaged )",
        "allowed: (with |so fast|to resume|whole (files|or)|finite (samples|coordinates))",
        "is there already|exists; name|, nothing is overwritten",
        "drills not|that is none|first so many|[Ww]rite so many|those there are|of it drilling|of "
        "them in sight",
        "--resume goes on|no part of the study\\)|fed more energy|is as it was"}) {
    blocks.emplace_back(words, std::regex::optimize);
  }
  return blocks;
}();

/// A source's text with the parts of each literal joined and its comments left out.
std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  std::string text = std::regex_replace(out.str(), std::regex("(^|\n)[ \t]*//[^\n]*"), "$1");
  return std::regex_replace(text, std::regex("\"[ \t]*\n[ \t]*\""), "");
}

/// The first stumbling block in a literal of `text`; empty if there is none.
std::string found_in(const std::string& text) {
  static const std::regex kLiteral("\"([^\"\\\\\n]|\\\\.)*\"");
  for (std::sregex_iterator it(text.begin(), text.end(), kLiteral), end; it != end; ++it) {
    for (const std::regex& block : kStumblingBlocks) {
      if (const std::string literal = it->str(); std::regex_search(literal, block)) {
        return literal;
      }
    }
  }
  return "";
}

TEST(WordsTest, NoSentenceHoldsAStumblingBlock) {
  int files = 0;
  for (const char* folder : {"core", "protocols", "experiments", "analysis"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h") {
        ++files;
        EXPECT_EQ(found_in(text_of(entry.path())), "") << entry.path();
      }
    }
  }
  EXPECT_GT(files, 400);
}

TEST(WordsTest, TheRulesFindWhatBreaksThem) {
  for (const char* text :
       {"f(\"{}: exists already; allowed: a new file\")", "f(\"allowed: exactly one\")",
        "f(\"it is the file of a session that drills not\")", "f(\"Chance of one that is none\")",
        "f(\"Only the first so many\")", "f(\"Time, of it drilling\")"}) {
    EXPECT_NE(found_in(text), "") << text;
  }
  EXPECT_EQ(found_in("f(\"--n is 1; allowed: a whole number of at least 2\")"), "");
}

}  // namespace
