// Statements of the documents are true: commands work, links lead somewhere, quoted messages and
// named tests exist.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::docs_test {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = HAPTRIAL_SOURCE_DIR;

std::vector<fs::path> documents() {
  std::vector<fs::path> files{kSource / "README.md", kSource / "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") {
      files.push_back(entry.path());
    }
  }
  return files;
}

/// A command of a manifest in results/, which ResultsTest runs; whatever folder it writes to.
bool made_by_a_result(const std::string& command) {
  static const std::set<std::string> kMade = [] {
    std::set<std::string> made;
    for (const auto& entry : fs::directory_iterator(kSource / "results")) {
      if (const fs::path file = entry.path() / "manifest.json"; fs::exists(file)) {
        const auto manifest = nlohmann::json::parse(test::read_text(file));
        for (const std::string line : manifest["commands"]) {
          made.insert("build/" + line);
        }
      }
    }
    return made;
  }();
  return kMade.contains(std::regex_replace(command, std::regex("--out \\S+"), "--out OUT"));
}

/// The lines of every block marked as shell. The two scripts of the first screen are left out: one
/// of them runs this test, and the other builds.
std::string shell_blocks(const fs::path& document) {
  std::istringstream text(test::read_text(document));
  std::string blocks;
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    const auto start = line.find_first_not_of(' ');
    const std::string content = start == std::string::npos ? "" : line.substr(start);
    if (content.starts_with("```")) {
      inside = !inside && content == "```sh";
    } else if (inside && !content.starts_with("./")) {
      blocks += content + "\n";
    }
  }
  return blocks;
}

std::vector<fs::path> documents_with_commands() {
  std::vector<fs::path> files = documents();
  std::erase_if(files, [](const fs::path& file) {
    std::string blocks = shell_blocks(file);
    if (!blocks.empty()) {
      blocks.pop_back();  // the last line's end
    }
    return blocks.empty() || made_by_a_result(blocks);  // no need to make it twice
  });
  std::sort(files.begin(), files.end());
  return files;
}

class ShownCommands : public testing::TestWithParam<fs::path> {};

TEST_P(ShownCommands, Work) {
  const test::TemporaryFolder checkout;  // looks like a checkout, and may be written to
  fs::create_directory_symlink(HAPTRIAL_BINARY_DIR, checkout / "build");
  fs::create_directory_symlink(kSource / "experiments", checkout / "experiments");
  fs::create_directory_symlink(kSource / "docs", checkout / "docs");
  const test::CommandResult result = test::run_command("set -e; cd '" + checkout.path().string() +
                                                       "'\n" + shell_blocks(GetParam()));
  // A machine that does something else besides may be too late for a device; the page says so.
  const bool only_late = result.status == 1 &&
                         result.output.find("FAIL  lateness") != std::string::npos &&
                         result.output.ends_with("is NOT fit for use\n");
  EXPECT_TRUE(result.status == 0 || only_late) << result.output << result.errors;
}

INSTANTIATE_TEST_SUITE_P(Docs, ShownCommands, testing::ValuesIn(documents_with_commands()),
                         [](const auto& shown) {
                           std::string name = fs::relative(shown.param, kSource).string();
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

TEST(DocsTest, TheDocumentsShowCommands) {
  std::ptrdiff_t commands = 0;
  for (const fs::path& document : documents_with_commands()) {
    const std::string blocks = shell_blocks(document);
    commands += std::count(blocks.begin(), blocks.end(), '\n');
  }
  EXPECT_GE(commands, 8) << "the documents lost their commands";
}

/// "#name" of every heading: lower case, blanks as hyphens, other signs left out.
std::vector<std::string> anchors(const fs::path& document) {
  std::vector<std::string> found;
  std::istringstream text(test::read_text(document));
  for (std::string line; std::getline(text, line);) {
    if (const auto title = line.find_first_not_of('#'); title != 0 && title != std::string::npos) {
      std::string anchor = "#";
      for (const unsigned char c : line.substr(title + 1)) {
        if (std::isalnum(c) != 0 || c == '-' || c == '_' || c > 127) {
          anchor += static_cast<char>(std::tolower(c));
        } else if (c == ' ') {
          anchor += '-';
        }
      }
      found.push_back(anchor);
    }
  }
  return found;
}

/// Every Markdown file that the project keeps.
std::vector<fs::path> markdown() {
  std::vector<fs::path> files = documents();
  files.push_back(kSource / "CHANGELOG.md");
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "results")) {
    if (entry.path().extension() == ".md") {
      files.push_back(entry.path());
    }
  }
  return files;
}

/// A document without its blocks and pieces of code, in which brackets are no links.
std::string without_code(const fs::path& document) {
  std::istringstream text(test::read_text(document));
  std::string rest;
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    const bool fence = line.find("```") != std::string::npos;
    inside = inside != fence;
    if (!inside && !fence) {
      rest += line + '\n';
    }
  }
  return std::regex_replace(rest, std::regex("`[^`\n]*`"), "`");
}

TEST(DocsTest, EveryLinkLeadsSomewhere) {
  const std::regex link("\\]\\(([^)# ]*)(#[^)]*)?\\)");
  int links = 0;
  for (const fs::path& document : markdown()) {
    const std::string text = without_code(document);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1];
      if (target.find("://") != std::string::npos) {
        continue;
      }
      const fs::path led = target.empty() ? document : document.parent_path() / target;
      EXPECT_TRUE(fs::exists(led)) << document << ": " << target;
      ++links;
      const std::string anchor = (*it)[2];
      if (!anchor.empty() && led.extension() == ".md" && fs::exists(led)) {
        EXPECT_THAT(anchors(led), testing::Contains(anchor)) << document << ": " << target;
      }
    }
  }
  EXPECT_GE(links, 300);
}

TEST(DocsTest, NamedTestsExist) {
  // A page that says which test shows something has to name one that is there.
  const std::regex defined("TEST(?:_F|_P)?\\((\\w+),\\s*(\\w+)");
  std::set<std::string> suites;
  std::set<std::string> cases;
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "tests")) {
    if (entry.path().extension() != ".cpp") {
      continue;
    }
    const std::string text = test::read_text(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), defined), end; it != end; ++it) {
      suites.insert((*it)[1]);
      cases.insert((*it)[1].str() + "." + (*it)[2].str());
    }
  }
  const std::regex named("`([A-Z][A-Za-z]*Test)(\\.([A-Za-z0-9]+))?`");
  for (const fs::path& document : documents()) {
    const std::string text = test::read_text(document);
    for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) {
      const std::string suite = (*it)[1];
      const std::string name = (*it)[3];
      EXPECT_TRUE(name.empty() ? suites.contains(suite) : cases.contains(suite + "." + name))
          << document << ": " << (*it)[0];
    }
  }
}

/// All sources of a folder, texts that go on in the next line joined.
std::string sources(const char* folder) {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(kSource / folder)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".cpp" || extension == ".h" || extension == ".html" || extension == ".js") {
      all += test::read_text(entry.path());
    }
  }
  return std::regex_replace(all, std::regex("\"\\s*\n\\s*\""), "");
}

TEST(DocsTest, QuotedMessagesAreThoseOfTheProgram) {
  // "When something goes wrong": what the program says, quoted in the first column.
  std::string program;
  for (const char* folder : {"core", "protocols", "analysis", "experiments"}) {
    program += sources(folder);
  }
  std::istringstream page(test::read_text(kSource / "docs/guide-first-participant.md"));
  const std::regex quoted("`([^`]+)`");
  const std::regex gap(" *(…|FILE\\S*|\\(No space.*\\)) *|  +");
  int quotes = 0;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    inside = (inside || line == "## When something goes wrong") && !line.starts_with("Tests");
    if (!inside || !line.starts_with("| ")) {
      continue;
    }
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::sregex_iterator it(cell.begin(), cell.end(), quoted), end; it != end; ++it) {
      const std::string quote = (*it)[1];
      for (std::sregex_token_iterator part(quote.begin(), quote.end(), gap, -1), last; part != last;
           ++part) {
        EXPECT_NE(program.find(part->str()), std::string::npos) << quote << ": " << *part;
        ++quotes;
      }
    }
  }
  EXPECT_GE(quotes, 15);
}

}  // namespace

// The site is made from the documents, and a real browser shows its pictures and finds words
// without a network.

namespace {

/// A dead link of a document and a warning of Doxygen about a header end the making with an error.
TEST(SiteTest, IsMadeAndWorksInABrowser) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "scripts make the site; there is nothing for the sanitizer";
  }
  const test::TemporaryFolder folder;
  const std::string site = (folder / "site").string();
  const test::CommandResult made =
      test::run_command(HAPTRIAL_SOURCE_DIR "/docs/site/make-site.sh '" + site + "'");
  ASSERT_EQ(made.status, 0) << made.output << made.errors;
  for (const char* page : {"index.html", "docs/keys.html", "docs/session-file.html",
                           "docs/sections.html", "headers/bvh_8h.html"}) {
    EXPECT_TRUE(std::filesystem::exists(site + "/" + page)) << page;
  }
  EXPECT_EQ(test::run_browser("site_browser.py", {site, folder.path().string()}), 0);
}

}  // namespace
}  // namespace haptrial::docs_test
