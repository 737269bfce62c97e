// The methods section of reports: its numbers against the session files, read one by one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using testing::HasSubstr;
using testing::Not;

class StudyMethodsTest : public testing::Test {
 protected:
  /// The report of a rehearsal of a shipped definition, after changes of it.
  std::string report_of(const std::string& definition, int subjects,
                        const std::string& changes = "", const std::string& options = "") {
    const std::string line = fmt::format(
        "cd '{0}' && rm -rf study new.toml && haptrial new new.toml --from {1} && {2} "
        "haptrial dry-run new.toml --subjects {3} {4} --out study && haptrial analyze study",
        folder_.path().string(), definition, changes.empty() ? "" : changes + " &&", subjects,
        options);
    const test::CommandResult done = test::run_command(line);
    EXPECT_EQ(done.status, 0) << done.errors;
    return test::read_text(folder_ / "study/report.md");
  }
  record::SessionReader session(int number) const {
    return record::SessionReader(folder_ / fmt::format("study/S{:02}.h5", number));
  }
  /// Passes of these sessions that were completed, by a condition and whether they are practice.
  int completed(int subjects, const std::string& condition, bool practice) const {
    int count = 0;
    for (int number = 1; number <= subjects; ++number) {
      for (const record::PassRow& pass : session(number).passes()) {
        count += pass.condition == condition && pass.practice == practice &&
                 pass.status == record::PassStatus::kCompleted;
      }
    }
    return count;
  }
  std::uint64_t samples(int subjects) const {
    std::uint64_t count = 0;
    for (int number = 1; number <= subjects; ++number) {
      count += session(number).sample_count();
    }
    return count;
  }

  test::TemporaryFolder folder_;
};

TEST_F(StudyMethodsTest, SaysOfAStaircaseWhatItsFilesHold) {
  const std::string report = report_of("stiffness_discrimination", 2);
  EXPECT_THAT(report,
              HasSubstr("2 participants are simulated (programs in the place of people) and "
                        "analysed in 2 sessions; 12 were planned."));
  EXPECT_THAT(report, HasSubstr(fmt::format("Of {} ticks of the loop 0 began later", samples(2))));
  EXPECT_THAT(report,
              HasSubstr("After 2 right answers in a row the task became harder (the level "
                        "fell), after each wrong answer easier, a rule in balance at 70.7 % "
                        "right answers."));
  EXPECT_THAT(report,
              HasSubstr("It ended after 10 reversals or 60 trials, whichever came first. The "
                        "estimate is the mean of reversals without the first 2."));
  EXPECT_THAT(report,
              HasSubstr(fmt::format("| main | presented | {} | 0 |", completed(2, "main", false))));
  EXPECT_THAT(report, HasSubstr(fmt::format("| practice: practice | presented | {} | 0 |",
                                            completed(2, "practice", true))));
}

TEST_F(StudyMethodsTest, AnotherRuleHasAnotherSentence) {
  const std::string report =
      report_of("stiffness_discrimination", 1,
                "sed -i 's/^down = 2 .*/down = 3/; s/reversals = 10/reversals = 8/' new.toml");
  EXPECT_THAT(report, HasSubstr("After 3 right answers in a row"));
  EXPECT_THAT(report, HasSubstr("in balance at 79.4 % right answers"));  // 0.5^(1/3)
  EXPECT_THAT(report, HasSubstr("It ended after 8 reversals or 60 trials"));
  EXPECT_THAT(report, Not(HasSubstr("After 2 right answers")));
}

TEST_F(StudyMethodsTest, NamesWhoIsLeftOutAndWhy) {
  report_of("wall_detection", 2);
  const test::CommandResult done = test::run_command(fmt::format(
      "cd '{}' && mkdir study/excluded && mv study/S02.h5 study/excluded && "
      "printf 'participant,reason\\nS02,fell asleep\\n' > study/excluded/reasons.csv && "
      "haptrial analyze study",
      folder_.path().string()));
  ASSERT_EQ(done.status, 0) << done.errors;
  const std::string report = test::read_text(folder_ / "study/report.md");
  EXPECT_THAT(report, HasSubstr("1 participant is simulated"));
  EXPECT_THAT(report, HasSubstr("excluded/S02.h5: excluded, fell asleep"));
}

TEST_F(StudyMethodsTest, SaysOfForceTrainingWhatItsFilesHold) {
  const std::string report = report_of("force_training", 2, "", "--trials 9");
  EXPECT_THAT(
      report,
      HasSubstr("The plan has 24 blocks, each with one path and one pattern of force 3 times"));
  EXPECT_THAT(report, HasSubstr("led along the path in its time by a spring of 900 N/m"));
  for (const std::string condition : {"haptic", "visual", "visuohaptic"}) {
    const int both = completed(2, condition, false);  // training and test
    EXPECT_THAT(report, HasSubstr(fmt::format("| {} | test | {} | 0 |", condition, both / 2)));
    EXPECT_THAT(report, HasSubstr(fmt::format("| {} | training | {} | 0 |", condition, both / 2)));
  }
}

}  // namespace
}  // namespace haptrial
