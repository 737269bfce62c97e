// One program with a kind of its own of everything: a device, a field, a shape, a renderer, a
// procedure, a question, a channel, a score and a finding (docs/worked/own). No file of the product
// knows any of them. Sessions with them are run, recorded, killed, resumed, analysed and reported.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::all_kinds_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kTrials = 6;

const std::string kStudy = R"([experiment]
protocol = "trials"
name = "all_kinds"
[design]
participants = 2
[fields.valley]
type = "valley"
strength = "$level"
width = 0.02
[fields.ring]
type = "ring"
centre = [0.0, 0.0, 0.0]
radius = 0.03
tube = 0.01
stiffness = 100.0
damping = 0.0
[objects.block]
shape = "box"
size = [0.02, 0.02, 0.02]
renderer = "lossy"
stiffness = 100.0
damping = 0.0
[[stages]]
name = "feel"
fields = ["valley", "ring", "block"]
until = { channel = "saw", above = 0.8, time = 0.2 }
timeout = { after = 20.0, then = "abort" }
[response]
name = "turn"
question = "Where did it push to?"
angle = [0, 355]
step = 5
[procedure]
kind = "robbins_monro"
variable = "level"
unit = "N"
range = [0.2, 2.0]
start = 1.0
gain = 0.5
target = 0.5
stop = { trials = 6 }
counts = "$turn >= 180"
[channels.saw]
kind = "saw"
period = 0.5
simulated = { mean = 0.5, amplitude = 0.5, frequency = 2.0 }
[observer]
decides = "magnitude"
exponent = 1.0
modulus = 200.0
actions.feel = { do = "hold" }
)";

class AllKindsTest : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "study.toml") << kStudy; }
  test::CommandResult own(const std::string& arguments, const std::string& before = "") {
    return test::run_command("cd '" + folder_.path().string() + "' && " + before +
                             HAPTRIAL_BINARY_DIR "/own_kinds " + arguments);
  }
  test::TemporaryFolder folder_;
};

TEST_F(AllKindsTest, AStudyIsRehearsedAnalysedAndReported) {
  auto ran = own("dry-run study.toml --out dry");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  for (const char* name : {"S01", "S02"}) {
    const record::SessionReader file(folder_ / "dry" / (std::string(name) + ".h5"));
    EXPECT_EQ(file.rows<record::LevelRow>().size(), static_cast<std::size_t>(kTrials));
    for (const record::ResponseRow& row : file.responses()) {
      EXPECT_EQ(row.question, "turn");
    }
  }
  ran = own("info dry/S01.h5");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("channel     saw: "));
  ran = own("analyze dry");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_THAT(ran.output, HasSubstr("Mean way of the hand in a pass: "));
  EXPECT_THAT(test::read_text(folder_ / "dry/report.md"),
              AllOf(HasSubstr("Way of the hand"), HasSubstr("## Channels"),
                    HasSubstr("threshold, level after the last trial")));
  EXPECT_THAT(test::read_text(folder_ / "dry/own_scores.csv"), HasSubstr(",way,"));
  EXPECT_EQ(test::run_command("haptrial validate " + (folder_ / "study.toml").string()).status, 2)
      << "the command knows none of them";
}

TEST_F(AllKindsTest, ALiveSessionThatIsKilledGoesOn) {
  const std::string run = "run study.toml --subject S01 --seed 7 --device virtual --out live";
  own(run, "timeout -s KILL 4 ");
  const bool begun = std::filesystem::exists(folder_ / "live/S01.h5.partial");
  const auto ran = own(begun ? run + " --resume" : run);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const record::SessionReader file(folder_ / "live/S01.h5");
  int completed = 0;
  for (const record::PassRow& pass : file.passes()) {
    completed += pass.status == record::PassStatus::kCompleted ? 1 : 0;
  }
  EXPECT_EQ(completed, kTrials);
  EXPECT_THAT(own("info live/S01.h5").output,
              AllOf(HasSubstr("channel     saw: "), HasSubstr("intact")));
}

TEST_F(AllKindsTest, ADeviceThatGoesRoundByItselfIsListedAndTested) {
  EXPECT_THAT(own("devices").output, HasSubstr("circle           ready"));
  EXPECT_THAT(own("device-test circle:0.02 --seconds 2").output, HasSubstr("circle"));
}

}  // namespace
}  // namespace haptrial::experiments::all_kinds_test
