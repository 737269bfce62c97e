// The site is made from the documents, and a real browser shows its pictures and finds words
// without a network.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::site_test {
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
}  // namespace haptrial::site_test
