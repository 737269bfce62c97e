// Rules for every test. check.sh installs each Debian package that a test needs, so a test may
// skip only if something else is missing, and its message names it: a variable
// HAPTRIAL_... (data that the project does not ship, or a test that takes minutes), a device file,
// root's rights or the network; or the sanitizer under which the test cannot run.
// A machine may be slow or stand still for a moment: a test waits for what it needs as long as it
// takes (tests/support/wait.h), and asserts no time. Times are measured by benchmarks.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::string whole_text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The skips of a source that give none of the reasons above.
std::vector<std::string> unfounded_skips(const std::string& text) {
  static const std::regex kSkip(
      "GTEST_SKIP\\(\\)([^;\"]|\"[^\"\n]*\")*;|skipTest\\([^\n]*|@unittest\\.skip[^\n]*");
  static const std::regex kReason("HAPTRIAL_[A-Z]|sanitizer|/dev/|root|network");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), kSkip), end; it != end; ++it) {
    if (const std::string skip = it->str(); !std::regex_search(skip, kReason)) {
      found.push_back(skip);
    }
  }
  return found;
}

TEST(SkipsTest, NoTestSkipsForWantOfAPackage) {
  int files = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / "tests")) {
    const fs::path& file = entry.path();
    const bool source = file.extension() == ".cpp" || file.extension() == ".py";
    if (source && file.filename() != "tests_test.cpp") {
      ++files;
      EXPECT_TRUE(unfounded_skips(whole_text(file)).empty())
          << file << ": " << testing::PrintToString(unfounded_skips(whole_text(file)));
    }
  }
  EXPECT_GT(files, 500);
}

TEST(SkipsTest, TheRuleFindsWhatBreaksIt) {
  EXPECT_EQ(unfounded_skips("GTEST_SKIP() << \"no Xvfb\";").size(), 1u);
  EXPECT_EQ(unfounded_skips("self.skipTest(\"no pandas\")\n").size(), 1u);
  EXPECT_TRUE(unfounded_skips("GTEST_SKIP() << \"HAPTRIAL_DATA lacks \" << name;").empty());
}

/// The first wait of a test with a limit of its own, or the first assertion on a time that a slow
/// machine breaks; empty if there is neither.
std::string impatience(const std::string& text) {
  static const std::regex kImpatient(
      "[Cc]lock::now\\(\\) *[<>]|"                                     // a deadline
      "\\balarm\\([0-9]|\\btimeout [0-9]+ |"                           // of a process
      "_L[TE]\\([^;\n]*([Cc]lock::now|seconds_since|perf_counter)|"    // a duration in C++
      "EXPECT_(NEAR|DOUBLE_EQ|G[TE])\\([^;\n]*rate_measured, [1-9]|"   // a rate
      "assertLess\\w*\\([^\n]*(seconds|elapsed|perf_counter|shares)",  // and in Python
      std::regex::optimize);
  std::smatch found;
  return std::regex_search(text, found, kImpatient) ? found.str() : "";
}

TEST(WaitsTest, NoTestIsImpatient) {
  int files = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / "tests")) {
    const std::string name = entry.path().filename().string();
    if ((name.ends_with("_test.cpp") || name.ends_with("_test.py")) && name != "tests_test.cpp") {
      ++files;
      EXPECT_EQ(impatience(whole_text(entry.path())), "") << entry.path();
    }
  }
  EXPECT_GT(files, 500);
}

TEST(WaitsTest, TheRuleFindsWhatBreaksIt) {
  for (const char* text :
       {"while (!good() && Clock::now() < end) {", "::alarm(60);",
        "run_command(\"timeout 500 python3 x.py\")", "EXPECT_LT(seconds_since(start), 2.0);",
        "EXPECT_NEAR(status.rate_measured, 1000.0, 100.0);", "self.assertLess(elapsed, 1.0)\n"}) {
    EXPECT_NE(impatience(text), "") << text;
  }
  EXPECT_EQ(impatience("test::wait_until([&] { return good(); });"), "");
}

}  // namespace
