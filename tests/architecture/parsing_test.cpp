// A definition's text is parsed once: what was read asks Definition::root() for the document.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace haptrial::parsing_test {
namespace {

namespace fs = std::filesystem;

bool parses_again(const std::string& source) {
  static const std::regex again(R"(Table::parse\(\s*[\w.>-]+(\.|->)(text\b|source\(\)))");
  return std::regex_search(source, again);
}

TEST(ParsingTest, NothingThatWasReadIsParsedAgain) {
  for (const char* folder : {"core", "protocols", "experiments", "analysis"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".cpp") {
        std::ifstream in(entry.path());
        const std::string source(std::istreambuf_iterator<char>(in), {});
        EXPECT_FALSE(parses_again(source))
            << entry.path() << ": ask the definition for root(), or a table for unread()";
      }
    }
  }
}

TEST(ParsingTest, AnotherParseIsSeen) {
  EXPECT_TRUE(parses_again("Table root = Table::parse(d.text, d.file_name);"));
  EXPECT_TRUE(parses_again("Table root = Table::parse(experiment.definition->text, name);"));
  EXPECT_TRUE(parses_again("Table copy = Table::parse(root.source(), \"\");"));
  EXPECT_FALSE(parses_again("Table root = Table::parse(text, file_name);"));
  EXPECT_FALSE(parses_again("Table root = Table::parse(info.definition, info.definition_name);"));
}

}  // namespace
}  // namespace haptrial::parsing_test
