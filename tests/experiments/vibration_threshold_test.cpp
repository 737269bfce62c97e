// A sound whose amplitude is a formula: a procedure finds the threshold of a virtual participant
// who answers by the level, and full scale is checked at the ends of its range.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::vibration_threshold_test {
namespace {

using testing::HasSubstr;

constexpr double kThreshold = 1.5;  // felt in half of the trials [m/s²]

const std::string kStudy = R"([experiment]
protocol = "trials"
name = "buzz"
[design]
participants = 1
[actuators.wrist]
channel = 3
full_scale = FULL
unit = "m/s²"
[sounds]
device = "null"
[sounds.buzz]
type = "tone"
actuator = "wrist"
frequency = 250.0
amplitude = "$level"
duration = 0.1
rise = 0.02
[[stages]]
name = "feel"
sound = "buzz"
until = { time = 0.1 }
[[responses]]
name = "felt"
question = "Did it vibrate?"
choices = [{ value = "yes", keys = ["Y"] }, { value = "no", keys = ["N"] }]
[procedure]
kind = "psi"
variable = "level"
unit = "m/s²"
levels = { from = 0.1, to = 10.0, count = 40, spacing = "log" }
scale = "log10"
function = "norm"
guess = 0.02
stop = { trials = 80 }
counts = "$felt == 1"
[[blocks]]
name = "detection"
[observer]
decides = "yes"
reaction = 0.05
script = { file = "decide.py" }
[observer.actions]
feel = { do = "hold" }
)";

const std::string kDecide = R"(import json, math, random, sys
for line in sys.stdin:
    asked = json.loads(line)
    level = asked["stimulus"][-1]["level"]
    felt = 0.5 * (1.0 + math.erf(math.log10(level / 1.5) / 0.1 / math.sqrt(2.0)))
    draw = random.Random(asked["seed"]).random()
    print(json.dumps({"answer": "yes" if draw < felt else "no"}), flush=True)
)";

class VibrationThresholdTest : public testing::Test {
 protected:
  std::string study(const std::string& full_scale) const {
    std::string text = kStudy;
    text.replace(text.find("FULL"), 4, full_scale);
    test::write_text(folder_ / "decide.py", kDecide);
    test::write_text(folder_ / "study.toml", text);
    return (folder_ / "study.toml").string();
  }
  test::TemporaryFolder folder_;
};

TEST_F(VibrationThresholdTest, AProcedureFindsThePlantedThreshold) {
  const std::string out = (folder_ / "out").string();
  const auto run = test::run_command("haptrial dry-run " + study("12.0") + " --out " + out);
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string said = test::run_command("haptrial analyze " + out).output;
  const std::string before = "Threshold: ";
  const std::size_t at = said.find(before);
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_NEAR(std::log10(std::stod(said.substr(at + before.size()))), std::log10(kThreshold), 0.08);
}

TEST_F(VibrationThresholdTest, ASessionDoesNotBeginWithoutTheCardThatGivesItsStimuli) {
  std::string text = test::read_text(study("12.0"));
  text.replace(text.find("\"null\""), 6, "\"hw:no-such-card\"");
  test::write_text(folder_ / "study.toml", text);
  const std::string out = (folder_ / "live").string();
  const auto said = test::run_command("haptrial run " + (folder_ / "study.toml").string() +
                                      " --subject S01 --device virtual --out " + out);
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.errors, HasSubstr("sound card 'hw:no-such-card'"));
  EXPECT_THAT(said.errors, HasSubstr("vibrations, and sounds that vary, need one"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "live/S01.h5.partial"));
}

TEST_F(VibrationThresholdTest, MoreThanFullScaleAtAnEndOfTheRangeIsRefused) {
  EXPECT_EQ(test::run_command("haptrial validate " + study("12.0")).status, 0);
  const auto said = test::run_command("haptrial validate " + study("8.0"));
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.errors, HasSubstr("sounds.buzz.amplitude is 10; allowed: at most 8 [m/s²], "
                                     "which is what wrist gives"));
  EXPECT_THAT(said.errors, HasSubstr("level = 10"));
}

}  // namespace
}  // namespace haptrial::experiments::vibration_threshold_test
