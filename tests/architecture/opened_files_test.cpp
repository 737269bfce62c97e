// A file that a user names is looked at before it is opened: a pipe or device might never end.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace haptrial::opened_files_test {
namespace {

namespace fs = std::filesystem;

/// Whether a source opens files to read, but for the system's own ("/proc/meminfo").
bool opens_files(const std::string& source) {
  static const std::regex opens(
      R"(std::ifstream [a-z]\w*\((?!"/proc)|std::ifstream\((?!"/proc)|fopen\(|sf_open\([^,]*, SFM_READ)"
      R"(|png_image_begin_read|\bdlopen\()");
  return std::regex_search(source, opens);
}

bool looks_first(const std::string& source) {
  static const std::regex looks(R"(refuse_special_file\(|is_regular_file\(|file_text\()");
  return std::regex_search(source, looks);
}

TEST(OpenedFilesTest, AreLookedAtBefore) {
  int found = 0;
  for (const char* folder : {"core", "protocols", "experiments", "analysis"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp") {
        continue;
      }
      std::ifstream in(entry.path());
      const std::string source(std::istreambuf_iterator<char>(in), {});
      if (opens_files(source)) {
        ++found;
        EXPECT_TRUE(looks_first(source))
            << entry.path() << ": call refuse_special_file() before the file is opened, or read it "
            << "with file_text() or file_head()";
      }
    }
  }
  EXPECT_GT(found, 5);
}

TEST(OpenedFilesTest, AnOpeningIsSeen) {
  EXPECT_TRUE(opens_files("std::ifstream in(file);"));
  EXPECT_TRUE(opens_files("std::ifstream(file).read(a, 8);"));
  EXPECT_TRUE(opens_files("File source(sf_open(file.c_str(), SFM_READ, &info));"));
  EXPECT_FALSE(opens_files("std::ifstream info(\"/proc/meminfo\");"));
  EXPECT_FALSE(opens_files("const std::string text = file_text(file);"));
}

}  // namespace
}  // namespace haptrial::opened_files_test
