// The site is made from the documents, every link of it leads somewhere, and a real browser shows
// its pictures and finds words without a network.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/experiments/command.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::site_test {
namespace {

class SiteTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer || test::kAddressSanitizer) {
      GTEST_SKIP() << "scripts make the site; there is nothing for the sanitizer";
    }
  }
  test::CommandResult make() const {
    return test::run_command(
        "HAPTRIAL=\"$HAPTRIAL\" " HAPTRIAL_SOURCE_DIR "/docs/site/make-site.sh '" + site_ + "'");
  }
  test::TemporaryFolder folder_;
  std::string site_{(folder_ / "site").string()};
};

/// Warnings of Doxygen about a public header, dead links of a document and pages that mkdocs does
/// not understand end the making with an error.
TEST_F(SiteTest, IsMadeWithoutDeadLinksAndWorksInABrowser) {
  const test::CommandResult made = make();
  ASSERT_EQ(made.status, 0) << made.output << made.errors;
  for (const char* page : {"index.html", "gallery/force_training.html", "reference/commands.html",
                           "docs/keys.html", "docs/session-file.html", "docs/sections.html",
                           "headers/bvh_8h.html", "search/search_index.js"}) {
    EXPECT_TRUE(std::filesystem::exists(site_ + "/" + page)) << page;
  }
  const std::string check = "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=" HAPTRIAL_SOURCE_DIR
                            "/docs/site /usr/bin/python3 -m site_check '" +
                            site_ + "'";
  const std::string broken =
      "sed -i 's@href=\"docs/keys.html@href=\"docs/gone.html@' '" + site_ + "/index.html'";
  EXPECT_EQ(test::run_command(check).status, 0);
  ASSERT_EQ(
      test::run_command("cp '" + site_ + "/index.html' '" + site_ + ".kept' && " + broken).status,
      0);
  const test::CommandResult dead = test::run_command(check);
  EXPECT_EQ(dead.status, 1);
  EXPECT_NE(dead.output.find("index.html: docs/gone.html"), std::string::npos) << dead.output;
  ASSERT_EQ(test::run_command("mv '" + site_ + ".kept' '" + site_ + "/index.html'").status, 0);

  const test::CommandResult shown =
      test::run_command("python3 -B " HAPTRIAL_SOURCE_DIR "/tests/experiments/site_browser.py '" +
                        site_ + "' '" + folder_.path().string() + "'");
  EXPECT_EQ(shown.status, 0) << shown.output << shown.errors;
}

}  // namespace
}  // namespace haptrial::site_test
