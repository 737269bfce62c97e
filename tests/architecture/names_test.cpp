// Names of a file's own. A folder can be compiled as one file, where a constant or function of one
// file would quietly stand for that of another: so no two files of a folder give the same name, and
// none takes that of a palette.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// The name in a line at the left margin of an anonymous namespace: a constant or a function.
std::optional<std::string> name_in(const std::string& line) {
  static const std::regex kConstant(
      "^(constexpr|const|inline|static)\\b[^=(]*?\\b(k[A-Z]\\w*)\\b.*");
  static const std::regex kFunction(
      "^(\\[\\[\\w+\\]\\] )?[\\w:<>,&* ]*?[\\w>&*] +[&*]?(\\w+)\\(.*");
  std::smatch found;
  if (std::regex_match(line, found, kConstant) || std::regex_match(line, found, kFunction)) {
    return found[2].str();
  }
  return std::nullopt;
}

/// Whether what follows a line is text, a shader's say, that a raw string holds.
bool is_text_after(const std::string& line, bool text) {
  static const std::regex kBegins("R\"\\w*\\((?!.*\\)\\w*\").*");
  static const std::regex kEnds("\\)\\w*\"");
  return text ? !std::regex_search(line, kEnds) : std::regex_search(line, kBegins);
}

/// The names that a file's anonymous namespace gives, each with the namespace around it.
std::set<std::string> own_names(std::istream& in) {
  std::set<std::string> names;
  std::string around;
  bool inside = false;
  bool text = false;
  for (std::string line; std::getline(in, line);) {
    const bool was_text = std::exchange(text, is_text_after(line, text));
    if (was_text) {
      continue;
    }
    if (line.starts_with("namespace haptrial")) {
      around = line.substr(line.find(' ') + 1, line.rfind(' ') - line.find(' ') - 1) + "::";
    } else if (line == "namespace {") {
      inside = true;
    } else if (line == "}  // namespace") {
      inside = false;
    } else if (inside && !line.empty() && std::isalpha(static_cast<unsigned char>(line[0]))) {
      if (const auto name = name_in(line)) {
        names.insert(around + *name);
      }
    }
  }
  return names;
}

/// Constants that files name without their namespace.
std::set<std::string> palette_names() {
  std::ifstream in(fs::path(HAPTRIAL_SOURCE_DIR) / "analysis/document/palette.h");
  std::set<std::string> names;
  for (std::string line; std::getline(in, line);) {
    if (std::smatch found; std::regex_search(line, found, std::regex("\\b(k[A-Z]\\w*) ="))) {
      names.insert(found[1].str());
    }
  }
  return names;
}

bool stands_alone(const fs::path& file) {
  return std::regex_search(file.string(), std::regex("(baseline|avx2|avx512)\\.cpp$"));
}

/// Benchmarks and fuzz targets: a program each.
bool is_a_program(const fs::path& file) {
  return std::regex_search(file.string(), std::regex("tests/(benchmarks|fuzz)/"));
}

TEST(NamesTest, FilesOfAFolderDoNotShareNamesOfTheirOwn) {
  const std::set<std::string> palette = palette_names();
  ASSERT_GT(palette.size(), 8U);
  std::map<std::pair<fs::path, std::string>, fs::path> given;
  for (const char* layer : {"core", "protocols", "experiments", "analysis", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / layer)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".cpp" || stands_alone(file) || is_a_program(file)) {
        continue;
      }
      std::ifstream in(file);
      for (const std::string& name : own_names(in)) {
        const auto [at, is_new] = given.try_emplace({file.parent_path(), name}, file);
        EXPECT_TRUE(is_new) << name << " is in " << at->second << " and in " << file;
        EXPECT_FALSE(std::string_view(layer) == "analysis" &&
                     palette.contains(name.substr(name.rfind(':') + 1)))
            << name << " in " << file << " hides that of the palette";
      }
    }
  }
  EXPECT_GT(given.size(), 1500U);
}

TEST(NamesTest, ConstantsAndFunctionsAreSeen) {
  EXPECT_EQ(name_in("constexpr int kMost = 3;"), "kMost");
  EXPECT_EQ(name_in("const std::array<int, 2> kTwo{1, 2};"), "kTwo");
  EXPECT_EQ(name_in("std::vector<std::string> row_of(const Effect& e) {"), "row_of");
  EXPECT_EQ(name_in("double share(double value, double f) {"), "share");
  EXPECT_FALSE(name_in("using Rows = std::vector<int>;"));
}

}  // namespace
