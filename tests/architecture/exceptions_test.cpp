// A user reads sentences, not the words in which the standard library names its functions.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace haptrial::exceptions_test {
namespace {

namespace fs = std::filesystem;

/// The handler of any exception that passes on its raw words, up to the end of the handler.
std::string raw_words(const std::string& source) {
  static const std::regex handler(R"(catch \(const std::exception& (\w+)\) \{)");
  for (std::sregex_iterator it(source.begin(), source.end(), handler), end; it != end; ++it) {
    const auto begin = static_cast<std::size_t>(it->position()) + it->str().size();
    const std::string body = source.substr(begin, source.find("\n  }", begin) - begin);
    if (body.find(it->str(1) + ".what()") != std::string::npos) {
      return body;
    }
  }
  return "";
}

TEST(ExceptionsTest, OfTheLibraryBecomeSentences) {
  for (const char* folder : {"core", "protocols", "experiments", "analysis"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(HAPTRIAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".cpp") {
        std::ifstream in(entry.path());
        EXPECT_EQ(raw_words({std::istreambuf_iterator<char>(in), {}}), "")
            << entry.path() << ": write sentence_of(error) of core/base/exception_words.h";
      }
    }
  }
}

TEST(ExceptionsTest, RawWordsAreSeen) {
  EXPECT_NE(raw_words("  } catch (const std::exception& e) {\n    say(e.what());\n  }\n"), "");
  EXPECT_EQ(raw_words("  } catch (const std::exception& e) {\n    say(1);\n  }\n  e.what();"), "");
}

}  // namespace
}  // namespace haptrial::exceptions_test
