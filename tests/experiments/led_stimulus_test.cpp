// Stimuli of a hand that is led: felt as often, and as strong, as whoever leads felt them.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::led_stimulus_test {
namespace {

namespace fs = std::filesystem;

const std::string kPulse = R"(type = "pulse"
force = [3.0, 0.0, 0.0]
duration = 1.0
)";
const std::string kVibration = R"(type = "vibration"
amplitude = 1.5
frequency = 100.0
direction = [1.0, 0.0, 0.0]
)";

class LedStimulusTest : public testing::Test {
 protected:
  /// A rest, and a stage as long as the pulse.
  fs::path write(const std::string& stimulus, double delay) const {
    test::write_text(folder_ / "study.toml", R"([experiment]
protocol = "trials"
name = "felt"
[design]
participants = 2
[fields.stimulus]
)" + stimulus + R"([[stages]]
name = "rest"
until = { time = 1.5 }
[[stages]]
name = "feel"
fields = ["stimulus"]
until = { time = 1.0 }
[[stages]]
name = "after"
until = { time = 0.5 }
[response]
question = "Did it move?"
choices = [{ value = "yes", keys = ["Y"] }, { value = "no", keys = ["N"] }]
[[blocks]]
name = "one"
trials = 2
[observer]
decides = "yes"
actions.feel = { do = "hold" }
[tutoring]
authority = 1.0
[tutoring.channel]
delay = )" + std::to_string(delay) + "\n");
    return folder_ / "study.toml";
  }
  std::string run(const std::string& options, const std::string& out) const {
    const auto done = test::run_command("cd '" + folder_.path().string() +
                                        "' && haptrial dry-run study.toml --subjects 1 " + options +
                                        " --out " + out);
    EXPECT_EQ(done.status, 0) << done.errors;
    return out + "/S01.h5";
  }
  double largest_force(const std::string& file) const {
    const record::SessionReader reader(folder_ / file);
    double largest = 0.0;
    for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
      largest = std::max(largest, std::abs(sample.force.x()));
    }
    EXPECT_TRUE(std::ranges::all_of(reader.passes(), [](const record::PassRow& pass) {
      return pass.status == record::PassStatus::kCompleted;
    })) << file;
    return largest;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LedStimulusTest, ARecordedPulseIsFeltOnce) {
  write(kPulse, 0.0);
  EXPECT_NEAR(largest_force(run("", "expert")), 3.0, 0.05);
  EXPECT_NEAR(largest_force(run("--seed 5 --tutor expert/S01.h5:1", "led")), 3.0, 0.25)
      << "and the spring";
}

TEST_F(LedStimulusTest, WhoIsTaughtFeelsTheTeachersStimulusAlone) {
  for (const double delay : {0.020, 0.024}) {
    SCOPED_TRACE(delay);
    const std::string name = std::to_string(static_cast<int>(1e3 * delay));
    write(kPulse, delay);
    EXPECT_NEAR(largest_force(run("--taught", "pulse" + name)), 3.0, 0.25) << "and the spring";
    write(kVibration, delay);
    EXPECT_NEAR(largest_force(run("--taught", "vibration" + name)), 1.5, 0.1);
  }
}

}  // namespace
}  // namespace haptrial::experiments::led_stimulus_test
