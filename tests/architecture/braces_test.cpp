// One brace style: the body of every branch and loop stands in braces.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

bool begins_with(const std::string& line, const char* word) {
  const std::size_t at = line.find_first_not_of(" \t}");
  return at != std::string::npos && line.compare(at, std::string(word).size(), word) == 0;
}

/// Whether a line, as clang-format leaves it, is a branch or loop with a body that has no braces.
bool is_bare(std::string line) {
  line.resize(std::min(line.size(), line.find("  //")));
  if (line.empty() || line.find("} while (") != std::string::npos) {
    return false;
  }
  const bool closed = std::ranges::count(line, '(') == std::ranges::count(line, ')');
  const bool headed =
      begins_with(line, "if (") || begins_with(line, "for (") || begins_with(line, "while (");
  if (headed && closed) {
    return line.back() == ';' || line.back() == ')';
  }
  return begins_with(line, "else") && line.back() != '{' && line.find('(') == std::string::npos;
}

TEST(BracesTest, EveryBranchAndLoopHasThem) {
  int files = 0;
  for (const char* folder : {"core", "protocols", "experiments", "analysis", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") {
        continue;
      }
      ++files;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number) {
        EXPECT_FALSE(is_bare(line)) << entry.path() << ":" << number << ": " << line;
      }
    }
  }
  EXPECT_GT(files, 900);
}

TEST(BracesTest, BareBodiesAreSeen) {
  EXPECT_TRUE(is_bare("  if (a) return;"));
  EXPECT_TRUE(is_bare("  for (int i = 0; i < 3; ++i) f(i);  // why"));
  EXPECT_TRUE(is_bare("  } else"));
  EXPECT_TRUE(is_bare("  while (f(a))"));
  EXPECT_FALSE(is_bare("  if (a) {"));
  EXPECT_FALSE(is_bare("  } while (a);"));
  EXPECT_FALSE(is_bare("  for (int i = 0;"));
  EXPECT_FALSE(is_bare("  } else {  // why"));
}

}  // namespace
