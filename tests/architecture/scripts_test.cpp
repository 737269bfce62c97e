// A rule for every shell script: nothing in a pipe stops reading before its end. The writer would
// die of a closed pipe now and then, and `set -o pipefail` make that the script's own failure.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace {

namespace fs = std::filesystem;

/// The first command that leaves a pipe early; empty if there is none.
std::string early_reader(const std::string& script) {
  static const std::regex kEarly(
      "\\| *(head\\b|grep -[a-zA-Z]*[qm]|(awk|sed)[^|\n]*\\b(exit|q)\\b)[^\n]*");
  std::smatch found;
  return std::regex_search(script, found, kEarly) ? found.str() : "";
}

/// Checks the scripts among these entries of folders; returns how many there were.
template <class Entries>
int check_scripts(Entries entries) {
  int scripts = 0;
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".sh") {
      ++scripts;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      EXPECT_EQ(early_reader(text), "") << entry.path();
    }
  }
  return scripts;
}

TEST(ScriptsTest, NothingLeavesAPipeEarly) {
  const fs::path root = HAPTRIAL_SOURCE_DIR;
  EXPECT_GE(check_scripts(fs::directory_iterator(root)), 2);
  for (const char* folder : {"cmake", "docs", "results", "tests"}) {
    EXPECT_GE(check_scripts(fs::recursive_directory_iterator(root / folder)), 1) << folder;
  }
}

TEST(ScriptsTest, TheRuleFindsWhatBreaksIt) {
  for (const char* text : {"ldconfig -p | awk '$1 == \"a\" { print; exit }'", "sort x | head -n 1",
                           "ninja -n | grep -q 'no work'", "ls | sed -n '1{p;q}'"}) {
    EXPECT_NE(early_reader(text), "") << text;
  }
  EXPECT_EQ(early_reader("sort x | sed -n 1p || exit 1"), "");
}

}  // namespace
