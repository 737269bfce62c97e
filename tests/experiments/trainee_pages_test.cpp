// Pages of trainees from whole sessions: by command, at the end of a session, in a real browser.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "analysis/bone_drilling/report/ratings.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::trainee_pages_test {
namespace {

namespace fs = std::filesystem;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

/// Dry run of a few seconds of the shipped drilling. @returns the folder of its sessions
fs::path drilled(const fs::path& folder, const std::string& subjects,
                 const std::vector<std::pair<std::string, std::string>>& more = {},
                 const std::string& tables = "") {
  std::vector<std::pair<std::string, std::string>> lines{{"time_limit", "time_limit = 3.0"},
                                                         {"procedures", "procedures = 2"},
                                                         {"card", "card = false"}};
  lines.insert(lines.end(), more.begin(), more.end());
  std::string text = test::drilling_with(lines);
  text.erase(text.find("[dust]"), text.find("[sound]") - text.find("[dust]"));
  test::write_text(folder / "study.toml", text + tables);
  const auto dry = run_command("haptrial dry-run " + (folder / "study.toml").string() +
                               " --subjects " + subjects + " --out " + (folder / "out").string());
  EXPECT_EQ(dry.status, 0) << dry.errors;
  return folder / "out";
}

TEST(TraineePagesTest, ABrowserTurnsTheBoneAndAsksNobody) {
  const test::TemporaryFolder folder;
  const fs::path out = drilled(folder.path(), "2");
  const auto made =
      run_command("haptrial bone page " + (out / "S01.h5").string() + " --expert " +
                  (out / "S02.h5").string() + " --out " + (folder / "S01.html").string());
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_LT(fs::file_size(folder / "S01-1.html"), 5'000'000u);
  EXPECT_THAT(test::read_text(folder / "S01-2.html"), HasSubstr("Expert S02, procedure"));
  EXPECT_EQ(test::run_browser("trainee_browser.py",
                              {(folder / "S01.html").string(), folder.path().string()}),
            0);
}

TEST(TraineePagesTest, ALeftEarIsSeenFromItsSurgeonsSide) {
  const test::TemporaryFolder folder;
  const fs::path out = drilled(folder.path(), "1",
                               {{"x_to", "place = \"surgeon's view of a left ear\"\nmirror = true"},
                                {"y_to", ""},
                                {"procedures", "procedures = 1"}});
  const std::string page = (folder / "left.html").string();
  const auto made =
      run_command("haptrial bone page " + (out / "S01.h5").string() + " --out " + page);
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string html = test::read_text(page);
  EXPECT_THAT(html, HasSubstr("Hidden when removed"));
  EXPECT_THAT(html, HasSubstr("\"name\":\"facial nerve\""));
  EXPECT_THAT(html, Not(HasSubstr("unknown")));
  const auto again =
      run_command("haptrial bone page " + (out / "S01.h5").string() + " --out " + page);
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("exists already; choose another name or add --overwrite"));
}

TEST(TraineePagesTest, ADefinitionAsksForThePageAtTheEnd) {
  const test::TemporaryFolder folder;
  const fs::path out = drilled(folder.path(), "1", {{"procedures", "procedures = 1"}},
                               "\n[feedback]\npage = true\n");
  const std::string html = test::read_text(out / "S01.html");
  EXPECT_THAT(html, HasSubstr("After a procedure: S01"));
  EXPECT_THAT(html, HasSubstr("SIMULATED: the participant is a program"));
  EXPECT_THAT(html, HasSubstr("not judged: there are no experts"));
}

TEST(TraineePagesTest, AScoreOfARatedStudyStandsOnTheNextTraineesPage) {
  const test::TemporaryFolder folder;
  const fs::path study = drilled(folder.path(), "5", {{"procedures", "procedures = 1"}}) / "";
  const std::string score = (folder / "score.json").string();
  const std::string learn = "haptrial bone score " + study.string() + " --out " + score;
  const auto unrated = run_command(learn);
  EXPECT_EQ(unrated.status, 2);
  EXPECT_THAT(unrated.errors, HasSubstr("holds no ratings.csv, so nothing is rated yet"));
  std::vector<analysis::drilling::Rating> ratings;
  for (int n = 1; n <= 5; ++n) {
    ratings.push_back(
        {"S0" + std::to_string(n) + ".h5", 1, "A", n % 2 == 0 ? 2.0 : 1.0 + 0.5 * n, "", false});
  }
  test::write_text(study / "ratings.csv", analysis::drilling::ratings_csv(ratings));
  const auto learned = run_command(learn);
  ASSERT_EQ(learned.status, 0) << learned.errors;
  EXPECT_THAT(learned.output, HasSubstr("from 5 rated procedures of 5 participants"));

  const std::string page = (folder / "S01.html").string();
  const auto made = run_command("haptrial bone page " + (study / "S01.h5").string() + " --score " +
                                score + " --out " + page);
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(test::read_text(page), HasSubstr("points of 5, 95 % interval"));

  const test::TemporaryFolder other;  // another time limit, and the page at the end of the session
  const fs::path out = drilled(
      other.path(), "1", {{"time_limit", "time_limit = 4.0"}, {"procedures", "procedures = 1"}},
      "\n[feedback]\npage = true\nscore = \"" + score + "\"\n");
  EXPECT_THAT(test::read_text(out / "S01.html"),
              HasSubstr("it was learned with another drilling.time_limit (3 s; here 4 s)"));

  const std::string labels = (study / "phases.csv").string();
  test::write_text(labels, "session,procedure,phase,start_s,end_s\nS01.h5,1,cortex,0,3\n");
  const auto own = run_command("haptrial bone phases " + study.string() + " --labels " + labels);
  EXPECT_EQ(own.status, 2);
  EXPECT_THAT(own.errors, HasSubstr("analyze writes this file anew, without corrections"));

  fs::copy_file(out / "S01.h5", study / "S06.h5");  // does not belong to the study
  const std::string divide = "haptrial bone phases " + study.string() + " --number 2";
  for (const std::string& command : {learn + " --overwrite", divide}) {
    const auto mixed = run_command(command);
    EXPECT_EQ(mixed.status, 2) << command;
    EXPECT_THAT(mixed.errors, HasSubstr("was recorded with another definition than")) << command;
  }
}

}  // namespace
}  // namespace haptrial::trainee_pages_test
