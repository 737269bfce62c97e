// check.sh installs every Debian package that a test needs. A test may therefore skip only if
// something else is missing, and its message names it: a variable HAPTRIAL_... (data that the
// project does not ship, or a test that takes minutes), a device file, root's rights or the
// network; or the sanitizer under which the test cannot run.

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

}  // namespace
