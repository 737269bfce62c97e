// Sessions that end with trials left, since too many were never completed: every place that speaks
// of the session says so.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::given_up_test {
namespace {

using testing::HasSubstr;

constexpr const char* kStudy = R"([experiment]
protocol = "trials"
name = "go_nogo"
[design]
participants = 1
[factors]
kind = ["go", "go", "go", "nogo"]
[fields.rest]
type = "viscous"
damping = 1.0
[[stages]]
name = "tap"
fields = ["rest"]
until = { time = 0.05 }
[response]
name = "go"
question = "Press for the strong tap"
choices = [{ value = "go" }, { value = "none" }]
correct = "$kind == 'go' ? 1 : 2"
timeout = 0.2
[[blocks]]
name = "main"
trials = 20
[observer]
[observer.script]
file = "slow.py"
[analysis]
kind = "none"
)";

constexpr const char* kSlow = R"(import json, sys
for line in sys.stdin:
    go = json.loads(line)["stimulus"][0]["kind"] == "go"
    print(json.dumps({"answer": "go", "reaction_time": 0.1 if go else 5.0}), flush=True)
)";

TEST(GivenUpTest, TrialsThatAreMissingAreSaidEverywhere) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", kStudy);
  test::write_text(folder / "slow.py", kSlow);
  const std::string out = (folder / "out").string();
  const auto dry =
      test::run_command("haptrial dry-run " + (folder / "study.toml").string() + " --out " + out);
  ASSERT_EQ(dry.status, 0) << "as the guide for experimenters says: " << dry.errors;
  EXPECT_THAT(dry.errors, HasSubstr("1 session ended with trials left"));
  EXPECT_THAT(test::run_command("haptrial info " + out + "/S01.h5").output,
              HasSubstr("block main ended with trials left"));
  const auto report = test::run_command("haptrial analyze " + out);
  ASSERT_EQ(report.status, 0) << report.errors;
  EXPECT_THAT(report.output, HasSubstr("of 20 planned trials of 1 participant"));
  EXPECT_THAT(report.output, HasSubstr("trials are missing: S01.h5 block main ended"));
  const auto results = nlohmann::json::parse(file_text(folder / "out" / "results.json"));
  EXPECT_EQ(results.at("participants").at(0).at("planned_trials_at_most"), 20);
  EXPECT_THAT(file_text(folder / "out" / "report.md"), HasSubstr("trials are missing"));
}

TEST(GivenUpTest, AStudyOfAbortedPassesSaysWhy) {
  const test::TemporaryFolder folder;
  std::string text = kStudy;
  const std::string end = "until = { time = 0.05 }";
  ASSERT_NE(text.find(end), std::string::npos);
  text.replace(text.find(end), end.size(),
               "until = { speed_above = 9.0 }\ntimeout = { after = 0.5, then = \"abort\" }");
  test::write_text(folder / "study.toml", text);
  test::write_text(folder / "slow.py", kSlow);
  const auto dry = test::run_command("haptrial dry-run " + (folder / "study.toml").string() +
                                     " --out " + (folder / "out").string());
  EXPECT_EQ(dry.status, 1);
  EXPECT_THAT(dry.errors, HasSubstr("every pass was aborted, the first since trial 1: a stage was "
                                    "not done in time: tap"));
  EXPECT_THAT(test::run_command("haptrial info " + (folder / "out" / "S01.h5").string()).output,
              HasSubstr("each of its 20 passes was aborted"))
      << "the rehearsal does not go on to its end";
}

}  // namespace
}  // namespace haptrial::experiments::given_up_test
