// Silence as an answer: a participant who feels nothing does nothing, as in go/no-go experiments.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::silence_test {
namespace {

using testing::HasSubstr;

std::string study(const std::string& choices, const std::string& timeout = "timeout = 0.8\n") {
  return R"([experiment]
protocol = "trials"
name = "go_no_go"
[design]
participants = 1
[factors]
push = [0.0, 2.0]
[fields.push]
type = "constant"
force = ["$push", 0.0, 0.0]
[[stages]]
name = "feel"
fields = ["push"]
until = { time = 0.4 }
[response]
question = "Press at once if you felt a push"
)" + timeout +
         "choices = [" + choices + R"(]
correct = "$push > 0 ? 1 : 2"
[[blocks]]
name = "one"
trials = 12
[observer]
senses = "force"
in_stage = "feel"
decides = "yes"
yes = "go"
criterion = 1.0
reaction = 0.3
actions.feel = { do = "hold" }
)";
}

constexpr const char* kGo = "{ value = \"go\", keys = [\"space\"] }";
constexpr const char* kNoGo = "{ value = \"no_go\", silent = true }";

class SilenceTest : public testing::Test {
 protected:
  test::CommandResult run(const std::string& text, const std::string& command) {
    const std::string file = folder_ / "go.toml";
    std::ofstream(file) << text;
    return test::run_command("haptrial " + command + " '" + file + "'" +
                             (command == "dry-run" ? " --subjects 1 --out " + out() : ""));
  }
  std::string out() const { return (folder_ / "out").string(); }
  test::TemporaryFolder folder_;
};

TEST_F(SilenceTest, IsTheChoiceThatSaysSo) {
  const auto result = run(study(std::string(kGo) + ", " + kNoGo), "dry-run");
  ASSERT_EQ(result.status, 0) << result.errors;
  const record::SessionReader session(folder_ / "out" / "S01.h5");
  const auto answers = session.rows<record::ResponseRow>();
  ASSERT_EQ(answers.size(), 12u);
  int go = 0;
  for (const record::ResponseRow& answer : answers) {
    go += answer.text == "go" ? 1 : 0;
    EXPECT_EQ(answer.correct, 1);
    EXPECT_EQ(std::isnan(answer.reaction_time), answer.text == "no_go") << answer.text;
  }
  EXPECT_EQ(go, 6);
  for (const record::PassRow& pass : session.passes()) {
    EXPECT_EQ(pass.status, record::PassStatus::kCompleted);
  }
  const auto report = test::run_command("haptrial analyze '" + out() + "'");
  EXPECT_EQ(report.status, 0) << report.errors;
}

TEST_F(SilenceTest, NeedsATimeAndIsOneChoice) {
  const auto without = run(study(std::string(kGo) + ", " + kNoGo, ""), "validate");
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.errors, HasSubstr("choices has a choice with silent = true, but nothing says "
                                        "when it is given; add timeout"));
  const auto two = run(
      study("{ value = \"go\", silent = true }, { value = \"no_go\", silent = true }"), "validate");
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.errors, HasSubstr("a list with 2 silent choices; allowed: at most one"));
}

}  // namespace
}  // namespace haptrial::experiments::silence_test
