// docs/sections.md: from each section of the source to header, page and test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace haptrial::sections_test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = HAPTRIAL_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The cells of each row of the table, by section.
std::map<std::string, std::vector<std::string>> rows() {
  std::map<std::string, std::vector<std::string>> found;
  std::istringstream page(text_of(kRoot / "docs/sections.md"));
  for (std::string line; std::getline(page, line);) {
    static const std::regex row(
        R"(^\| (\d[\d.]*) \| ([^|]*) \| ([^|]*) \| ([^|]*) \| ([^|]*) ?\|$)");
    std::smatch cells;
    if (std::regex_match(line, cells, row)) {
      found[cells[1]] = {cells[2], cells[3], cells[4], cells[5]};
    }
  }
  return found;
}

/// "core/bone/drill/feel.h" of "`core/bone/drill/feel.h`", "guide-bone.md" of
/// "[guide](guide-bone.md)".
std::string path_in(const std::string& cell) {
  static const std::regex path(R"(`([^`]+)`|\]\(([^)]+)\))");
  std::smatch found;
  if (!std::regex_search(cell, found, path)) {
    return "";
  }
  return found[1].matched ? found[1].str() : found[2].str();
}

/// "4.2.3" of "§4.2.3" and of "§4.2.3 and §4.3".
std::set<std::string> sections_in(const std::string& text) {
  static const std::regex section(R"(§\s?(\d(?:\.\d+)*))");
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), section), end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

TEST(SectionsTest, EveryRowLeadsSomewhere) {
  ASSERT_GT(rows().size(), 25u);
  for (const auto& [section, cells] : rows()) {
    if (cells[1].starts_with("not built yet")) {
      continue;
    }
    const std::string header = path_in(cells[1]);
    ASSERT_TRUE(fs::exists(kRoot / header)) << section << ": " << header;
    EXPECT_TRUE(sections_in(text_of(kRoot / header)).contains(section))
        << section << ": " << header;
    EXPECT_TRUE(fs::exists(kRoot / "docs" / path_in(cells[2]))) << section << ": " << cells[2];
    EXPECT_TRUE(fs::exists(kRoot / path_in(cells[3]))) << section << ": " << cells[3];
  }
}

TEST(SectionsTest, EverySectionThatAHeaderNamesHasARow) {
  const auto known = rows();
  for (const char* layer : {"core", "protocols", "analysis", "experiments"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / layer)) {
      if (entry.path().extension() != ".h") {
        continue;
      }
      for (const std::string& section : sections_in(text_of(entry.path()))) {
        // A whole chapter, or what a row stands for a part of.
        const auto below = known.lower_bound(section);
        EXPECT_TRUE(below != known.end() && below->first.starts_with(section))
            << entry.path() << " names section " << section;
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::sections_test
