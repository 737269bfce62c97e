// A curriculum from a trainee's first procedure to the last, as files alone tell it: what comes
// next, the trainee's page and that of the class. All simulated.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/bone/data/bone_file.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::curriculum_session_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Two small bones; the virtual hand removes some bone in every procedure and never spends an hour.
class CurriculumSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::write_small_drilling(folder_->path(), 2.0,
                               {{"procedures", "procedures = 1\nsessions = 6"},
                                {"participants", "participants = 2"},
                                {"break_after", "break_after = 0"}});
    bone::BoneModel other = test::two_slabs();
    other.labels[other.grid.index(0, 0, 0)] = 0;
    bone::save_bone(*folder_ / "other.nrrd", other);
    const std::string text = test::read_text(*folder_ / "study.toml");
    const std::size_t bones = text.find("[\"slabs.nrrd\"]");
    whole_ = text;
    whole_.replace(bones, 14, "[\"slabs.nrrd\", \"other.nrrd\"]");
    write("study.toml", "removed >= 0.001", "time <= 3600");
    good("dry-run study.toml --out out");
    write("hard.toml", "removed >= 0.001", "time >= 3600");
    good("dry-run hard.toml --subjects 1 --out hard");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static void write(const std::string& name, const std::string& first, const std::string& second) {
    test::write_text(*folder_ / name, whole_ + R"(
[feedback]
page = true
[curriculum]
[[curriculum.cases]]
name = "plain"
pass = [")" + first + R"("]
in_a_row = 2
[[curriculum.cases]]
name = "other"
bone = "other.nrrd"
pass = [")" + second + R"("]
repeat = "plain"
after = 2
)");
  }
  static test::CommandResult run(const std::string& arguments) {
    return test::run_command("cd '" + folder_->path().string() + "'; haptrial " + arguments);
  }
  static std::string good(const std::string& arguments) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.errors;
    return result.output + result.errors;
  }
  static std::string refused(const std::string& arguments) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    return result.errors;
  }
  /// The cases of a participant's sessions, in their order.
  static std::vector<std::string> cases(const std::string& folder, const std::string& subject) {
    std::vector<std::string> all;
    for (int number = 1; number <= 6; ++number) {
      const fs::path file =
          fs::path(*folder_ / folder) / (subject + "-session-" + std::to_string(number) + ".h5");
      if (fs::exists(file)) {
        all.push_back(record::SessionReader(file).passes().back().condition);
      }
    }
    return all;
  }
  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::string whole_;  // the definition without a curriculum
};
std::unique_ptr<test::TemporaryFolder> CurriculumSessionTest::folder_;
std::string CurriculumSessionTest::whole_;

TEST_F(CurriculumSessionTest, WhoPassesGoesOnAndEndsEarly) {
  EXPECT_THAT(cases("out", "S01"), ElementsAre("plain", "plain", "other"));
  EXPECT_THAT(cases("out", "S02"), ElementsAre("plain", "plain", "other"));
  EXPECT_THAT(good("next study.toml out"), HasSubstr("every planned participant has had every"));
}

TEST_F(CurriculumSessionTest, WhoFailsTooOftenGoesBack) {
  EXPECT_THAT(cases("hard", "S01"),
              ElementsAre("plain", "plain", "other", "other", "plain", "plain"));
  fs::create_directory(*folder_ / "begun");
  for (const char* number : {"1", "2", "3"}) {
    const std::string name = std::string("S01-session-") + number + ".h5";
    fs::copy_file(fs::path(*folder_ / "hard") / name, fs::path(*folder_ / "begun") / name);
  }
  EXPECT_THAT(good("roster hard.toml begun"),
              AllOf(HasSubstr("S01, session 4 of 6: case other (missed last: time "),
                    HasSubstr(" s (at least 3600))")));
}

TEST_F(CurriculumSessionTest, ASessionHoldsTheBoneOfItsCaseAndReplays) {
  const fs::path third = fs::path(*folder_ / "out") / "S01-session-3.h5";
  const auto bones = record::recorded_bones(record::SessionReader(third));
  ASSERT_EQ(bones.size(), 1u);
  EXPECT_EQ(bone::model_of(bones.front()).labels[0], 0) << "the other bone lacks a corner";
  EXPECT_THAT(good("replay '" + third.string() + "'"), HasSubstr("the same bone"));
}

/// The roster would propose "plain" to a trainee who has finished nothing.
TEST_F(CurriculumSessionTest, AResumedSessionKeepsItsCase) {
  fs::create_directory(*folder_ / "cut");
  fs::copy_file(fs::path(*folder_ / "out") / "S01-session-3.h5",
                fs::path(*folder_ / "cut") / "S01-session-3.h5.partial");
  const std::string resume =
      "run study.toml --subject S01 --session 3 --resume --device virtual --out cut";
  EXPECT_THAT(refused(resume + " --case plain"),
              HasSubstr("--case is 'plain', but the session that is to be resumed is of the case "
                        "'other'; leave out --case"));
  EXPECT_THAT(run(resume).output, HasSubstr("case other"));
}

TEST_F(CurriculumSessionTest, PagesSayHowEverybodyStands) {
  const std::string page = test::read_text(*folder_ / "out/S01-session-3.html");
  EXPECT_THAT(page, AllOf(HasSubstr("<h2>Curriculum</h2>"), HasSubstr("2 procedures, 2 passed"),
                          HasSubstr("bone removed at least 0.001 mm3; 2 procedures in a row")));
  good("bone class study.toml out --out class.html");
  EXPECT_THAT(test::read_text(*folder_ / "class.html"),
              AllOf(HasSubstr("Class of"), HasSubstr("SIMULATED"), HasSubstr("every case is done"),
                    HasSubstr("S02"), HasSubstr("time at most 3600 s")));
  EXPECT_THAT(refused("bone class study.toml out --out class.html"), HasSubstr("exists already"));
  good("bone class hard.toml hard --out hard.html");
  EXPECT_THAT(test::read_text(*folder_ / "hard.html"),
              AllOf(HasSubstr("no session is left; other is not done"), HasSubstr("open, 2 proc")));
  EXPECT_THAT(test::read_text(*folder_ / "hard/S01-session-6.html"),
              HasSubstr("No session is left; other is not done."));
  test::write_text(*folder_ / "none.toml", whole_);
  EXPECT_THAT(refused("bone class none.toml out --out none.html"),
              HasSubstr("has no [curriculum]"));
}

/// The first case needs two procedures, the second one; what a session has beyond its case is lost.
TEST_F(CurriculumSessionTest, ACurriculumThatNobodyCanFinishIsSaid) {
  EXPECT_THAT(good("validate study.toml"), Not(HasSubstr("nobody can finish it")));
  const auto validated = [](const std::string& design) {
    std::string few = test::read_text(*folder_ / "study.toml");
    const std::string own = "procedures = 1\nsessions = 6";
    few.replace(few.find(own), own.size(), design);
    test::write_text(*folder_ / "few.toml", few);
    return good("validate few.toml");
  };
  const std::string warning = "enough for 1 of the 2 cases";
  EXPECT_THAT(validated("procedures = 1\nsessions = 2"), HasSubstr(warning));
  EXPECT_THAT(validated("procedures = 3\nsessions = 1"), HasSubstr(warning));
  EXPECT_THAT(validated("procedures = 1\nsessions = 3"), Not(HasSubstr(warning)));
  EXPECT_THAT(validated("procedures = 2\nsessions = 2"), Not(HasSubstr(warning)));
}

TEST_F(CurriculumSessionTest, MistakesGetASentence) {
  write("bad.toml", "remved >= 1", "time <= 3600");
  EXPECT_THAT(refused("validate bad.toml"), HasSubstr("did you mean removed?"));
  write("bad.toml", "score >= 3", "time <= 3600");
  EXPECT_THAT(refused("validate bad.toml"), HasSubstr("name its file in feedback.score"));
  write("bad.toml", "bone_left_facial_nerv_mm >= 3", "time <= 3600");
  EXPECT_THAT(refused("validate bad.toml"), HasSubstr("did you mean bone_left_facial_nerve_mm?"));
  write("bad.toml", "bone_left_facial_nerve_mm >= 12", "time <= 3600");
  EXPECT_THAT(refused("validate bad.toml"), HasSubstr("allowed: up to 10 mm"));
  EXPECT_THAT(refused("run study.toml --subject P01 --case plane --out people"),
              HasSubstr("has no case 'plane'"));
  EXPECT_THAT(refused("dry-run study.toml --parts parts"), HasSubstr("leave it out"));
  EXPECT_THAT(refused("run study.toml --subject S01 --out out"), HasSubstr("has done every case"));
}

}  // namespace
}  // namespace haptrial::experiments::curriculum_session_test
