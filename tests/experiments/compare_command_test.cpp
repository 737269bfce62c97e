#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

class CompareCommandTest : public testing::Test {
 protected:
  /// Runs and analyses a small study of virtual subjects.
  void make_study(const std::string& name, const std::string& more,
                  const fs::path& definition = test::shipped_definition()) {
    const CommandResult made = run_command("haptrial dry-run '" + definition.string() +
                                           "' --subjects 2 --trials 9 --out " + path(name) + " " +
                                           more + " && haptrial analyze " + path(name));
    ASSERT_EQ(made.status, 0) << made.errors;
  }

  CommandResult compare(const std::string& first, const std::string& second,
                        const std::string& more = "") {
    return run_command("haptrial compare " + path(first) + " " + path(second) + " " + more);
  }

  std::string path(const std::string& name) const {
    const std::string quote = "'";
    return quote + (folder_ / name).string() + quote;
  }

  test::TemporaryFolder folder_;
};

TEST_F(CompareCommandTest, OtherSeedsAreOtherPeople) {
  make_study("one", "--seed 1");
  make_study("two", "--seed 2");
  make_study("pace", "--seed 1",
             test::shipped_definition().parent_path() / "force_training_curve.toml");
  const CommandResult other = compare("one", "two");
  EXPECT_EQ(other.status, 0) << other.errors;
  EXPECT_THAT(other.output, testing::StartsWith("SIMULATED PARTICIPANTS"));
  EXPECT_THAT(other.output, HasSubstr("No participant is paired. Not paired: S01, S02 (virtual "
                                      "subjects of different seeds: 1 and 2)."));
  const CommandResult same = compare("one", "pace");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("Paired: 2 participants."));
  EXPECT_THAT(same.output, HasSubstr("force_training_curve compares forces over the place on the "
                                     "path, force_training over time."));
  const std::string differ = "The definitions differ in what was presented, recorded or scored: ";
  EXPECT_THAT(same.output, HasSubstr(differ));
  EXPECT_THAT(same.output, HasSubstr("guidance.kind was absent, is \"curve\""));
  EXPECT_THAT(other.output, testing::Not(HasSubstr("The definitions differ")));
}

TEST_F(CompareCommandTest, OtherScoringIsRefusedUnlessAskedFor) {
  std::string text = test::read_text(test::shipped_definition());
  const std::string key = "filter_width = 0.1 ";
  ASSERT_NE(text.find(key), std::string::npos);
  text.replace(text.find(key), key.size(), "filter_width = 0.2 ");
  std::ofstream(folder_ / "wide.toml") << text;
  make_study("one", "");
  make_study("wide", "", folder_ / "wide.toml");
  const CommandResult refused = compare("one", "wide", "--out " + path("out"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("scored with different parameters (box filter on the "
                                        "applied force: 0.1 s and 0.2 s)"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  const CommandResult asked = compare("one", "wide", "--different-scoring --out " + path("out"));
  EXPECT_EQ(asked.status, 0) << asked.errors;
  EXPECT_THAT(asked.output, testing::StartsWith("DIFFERENT SCORING"));
  const std::string page = test::read_text(folder_ / "out/comparison.html");
  EXPECT_LT(page.find("DIFFERENT SCORING"), page.find("class=\"lines\""));
}

}  // namespace
}  // namespace haptrial
