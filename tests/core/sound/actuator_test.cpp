// Vibrations of actuators: their samples by the calibration, what is refused, and the channels of a
// card, from a file that ALSA writes beside a card that swallows everything.

#include "core/sound/cue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/definition/number_source.h"
#include "core/base/definition/table.h"
#include "core/base/file_text.h"
#include "core/sound/card_player.h"
#include "core/sound/cue_player.h"
#include "core/sound/read_cues.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::sound {
namespace {

using testing::HasSubstr;

constexpr const char* kActuators = R"([actuators.wrist]
channel = 4
full_scale = 30.0
unit = "m/s²"
lowest = 40.0
highest = 500.0
)";

CueSet read(const std::string& sounds, const std::string& actuators = kActuators) {
  Table root = Table::parse(actuators + sounds, "study.toml");
  Table table = root.table("sounds");
  CueSet set = read_cues(table, read_actuators(root));
  root.finish();
  return set;
}

std::string buzz(const std::string& keys) { return "[sounds.buzz]\nactuator = \"wrist\"\n" + keys; }

TEST(ActuatorTest, ATonesPeakIsItsAmplitudeByTheCalibration) {
  const CueSet set =
      read(buzz("type = \"tone\"\nfrequency = 250.0\nduration = 0.5\namplitude = 12.0\n"));
  const std::vector<float> samples = rendered(set.cues[0], 1);
  for (std::size_t i = 1000; i < 20'000; ++i) {
    const double time = static_cast<double>(i) / CardPlayer::kRate;
    const double acceleration = 12.0 * std::sin(2.0 * std::numbers::pi * 250.0 * time);
    ASSERT_NEAR(30.0 * samples[i], acceleration, 1e-4) << i;
  }
}

TEST(ActuatorTest, ANoisesRootMeanSquareIsItsAmplitude) {
  const CueSet set =
      read(buzz("type = \"noise\"\ncolour = \"band\"\nlow = 60.0\nhigh = 400.0\nduration = 2.0\n"
                "rise = 0.0\namplitude = 5.0\n"));
  double square = 0.0;
  const std::vector<float> samples = rendered(set.cues[0], 1);
  for (const float sample : samples) {
    square += static_cast<double>(sample) * sample;
  }
  EXPECT_NEAR(30.0 * std::sqrt(square / static_cast<double>(samples.size())), 5.0, 1e-3);
}

TEST(ActuatorTest, WhatTheActuatorCannotGiveIsRefused) {
  const auto said = [](const std::string& sounds) {
    return test::message_of([&] { read(sounds); });
  };
  const std::string tone = "type = \"tone\"\nduration = 0.5\n";
  EXPECT_THAT(said(buzz(tone + "frequency = 250.0\namplitude = 31.0\n")),
              HasSubstr("sounds.buzz.amplitude is 31; allowed: at most 30 [m/s²], which is what "
                        "wrist gives"));
  EXPECT_THAT(said(buzz(tone + "frequency = 700.0\namplitude = 3.0\n")),
              HasSubstr("allowed: 40 to 500 [Hz], for which wrist is calibrated"));
  EXPECT_THAT(said(buzz(tone + "frequency = 250.0\nlevel = -20.0\n")),
              HasSubstr("sounds.buzz.amplitude is missing"));
  EXPECT_THAT(
      said("[sounds.buzz]\nactuator = \"nose\"\namplitude = 1.0\nfrequency = 250.0\n" + tone),
      HasSubstr("sounds.buzz.actuator is \"nose\"; allowed: a name of [actuators]"));
  const std::string noise = "type = \"noise\"\nduration = 0.5\ncolour = \"band\"\nlow = 60.0\n";
  EXPECT_THAT(said(buzz(noise + "high = 400.0\namplitude = 7.0\n")),
              HasSubstr("sounds.buzz.amplitude is 7; allowed: at most 6 [m/s²]"));
  EXPECT_THAT(said(buzz(noise + "high = 4000.0\namplitude = 5.0\n")),
              HasSubstr("sounds.buzz.colour is of 60 to 4000 Hz; allowed: \"band\" with low and "
                        "high from 40 to 500 [Hz]"));
  const std::string twin = "[actuators.ankle]\nchannel = 4\nfull_scale = 1.0\nunit = \"g\"\n";
  EXPECT_THAT(test::message_of([&] { read("[sounds]\ndevice = \"null\"\n", kActuators + twin); }),
              HasSubstr("channel is that of wrist, too"));
}

TEST(ActuatorTest, TheLargestNoiseThatIsAllowedIsNotCutOff) {
  const CueSet set =
      read(buzz("type = \"noise\"\nduration = 10.0\ncolour = \"band\"\n"
                "low = 60.0\nhigh = 400.0\namplitude = 6.0\n"));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const float sample : rendered(set.cues[0], seed)) {
      ASSERT_LE(std::abs(sample), 1.0F) << seed;
    }
  }
}

/// Samples of each channel that a card of four was given, for half a second or more.
std::array<std::vector<float>, 4> played(const std::string& sounds,
                                         const std::vector<std::size_t>& cues, bool stilled = false,
                                         const std::vector<Cue>& varied = {}) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "played.raw").string();
  {
    CueSet set = read(sounds);
    set.device = "tee:null," + file + ",raw";
    CuePlayer player(set, 1, [] { return 0; });
    player.take_varied(varied);
    for (const std::size_t cue : cues) {
      player.start(cue, cue);
    }
    std::size_t started = 0;
    while (started < cues.size()) {
      started += player.take_started().size();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (stilled) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      player.still();
    }
    // The card is given the whole sound, and what follows.
    constexpr std::uintmax_t kWritten = 4 * sizeof(float) * 24'000;
    while (std::filesystem::file_size(file) < kWritten) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  const std::string bytes = file_text(file);
  std::array<std::vector<float>, 4> channels;
  for (std::size_t i = 0; i + sizeof(float) <= bytes.size(); i += sizeof(float)) {
    float sample = 0.0F;
    std::memcpy(&sample, bytes.data() + i, sizeof(float));
    channels[i / sizeof(float) % 4].push_back(sample);
  }
  return channels;
}

double largest(const std::vector<float>& samples) {
  double most = 0.0;
  for (const float sample : samples) {
    most = std::max(most, std::abs(static_cast<double>(sample)));
  }
  return most;
}

TEST(ActuatorTest, AVibrationIsStilledAndASoundIsNot) {
  const std::string tone = "type = \"tone\"\nfrequency = 250.0\nduration = 60.0\n";
  const std::string sounds =
      "[sounds.beep]\nlevel = -20.0\n" + tone + buzz(tone + "amplitude = 15.0\n");
  const auto channels = played(sounds, {0, 1}, true);
  const std::size_t end = channels[3].size() - 4800;
  EXPECT_GT(largest(channels[3]), 0.4);
  EXPECT_EQ(largest({channels[3].begin() + static_cast<std::ptrdiff_t>(end), channels[3].end()}),
            0.0);
  EXPECT_GT(largest({channels[0].begin() + static_cast<std::ptrdiff_t>(end), channels[0].end()}),
            0.1);
}

TEST(ActuatorTest, AVibrationThatIsStilledBeforeItBeginsIsToldOf) {
  CueSet set = read(buzz("type = \"tone\"\nfrequency = 250.0\nduration = 0.2\namplitude = 15.0\n"));
  set.device = "null";
  CuePlayer player(set, 1, [] { return 7; });
  std::vector<StartedCue> told;
  constexpr std::uint64_t kTimes = 40;
  for (std::uint64_t ticket = 0; ticket < kTimes; ++ticket) {
    player.start(0, ticket);
    player.still();
    test::wait_until([&] {
      std::ranges::copy(player.take_started(), std::back_inserter(told));
      return told.size() > ticket;
    });
    EXPECT_EQ(told.at(ticket).ticket, ticket);
  }
  const auto never = [](const StartedCue& cue) { return cue.handed_ns == -1; };
  EXPECT_GT(std::ranges::count_if(told, never), 0) << "the card takes 5 ms at once";
}

TEST(ActuatorTest, SoundsOfATrialArePlayedInThePlaceOfThoseBefore) {
  const std::string sounds =
      "[sounds.beep]\ntype = \"tone\"\nfrequency = 1000.0\nduration = 0.2\nlevel = -20.0\n" +
      buzz("type = \"tone\"\nfrequency = 250.0\nduration = 0.2\namplitude = 15.0\n");
  std::vector<Cue> varied = read(sounds).cues;
  for (Cue& cue : varied) {
    cue.level -= 20.0;
  }
  const auto channels = played(sounds, {2, 3}, false, varied);
  EXPECT_NEAR(largest(channels[0]), 0.01 * std::numbers::sqrt2, 1e-4);
  EXPECT_NEAR(largest(channels[3]), 0.05, 1e-4);
}

/// A trial's names: one of them.
class TrialNames final : public NumberSource {
 public:
  explicit TrialNames(double level) : level_(level) {}
  std::optional<double> value_of(std::string_view text) const override {
    return text == "$level" ? std::optional(level_) : std::nullopt;
  }
  std::optional<Eigen::Vector3d> vector_of(std::string_view) const override { return {}; }

 private:
  double level_;
};

TEST(ActuatorTest, AnAmplitudeByAFormulaIsHeldToFullScaleInEachTrial) {
  Table root = Table::parse(
      kActuators + buzz("type = \"tone\"\nfrequency = 250.0\nduration = 0.5\namplitude = "
                        "\"$level\"\n"),
      "study.toml");
  Table table = root.table("sounds");
  const CueSet set = read_cues(table, read_actuators(root));
  ASSERT_TRUE(set.cues.at(0).varies);
  const auto rendered_with = [&](double level) {
    const TrialNames names(level);
    Table named = root.with(names).table("sounds");
    const std::vector<Cue> cues = read_varied_cues(named, set);
    root.finish();
    return rendered(cues.at(0), 1);
  };
  for (const double level : {0.5, 12.0, 30.0}) {
    EXPECT_NEAR(30.0 * largest(rendered_with(level)), level, 1e-3 * level);
  }
  EXPECT_THAT(test::message_of([&] { rendered_with(31.0); }),
              HasSubstr("sounds.buzz.amplitude is 31; allowed: at most 30 [m/s²]"));
}

TEST(ActuatorTest, EachSoundIsOnItsChannelOfTheCard) {
  const std::string sounds =
      "[sounds.beep]\ntype = \"tone\"\nfrequency = 1000.0\nduration = 0.2\nlevel = -20.0\n" +
      buzz("type = \"tone\"\nfrequency = 250.0\nduration = 0.2\namplitude = 15.0\n");
  const auto buzzed = played(sounds, {1});
  ASSERT_GT(buzzed[3].size(), 9600u);
  EXPECT_NEAR(largest(buzzed[3]), 0.5, 1e-3);
  for (const std::size_t other : {0, 1, 2}) {
    EXPECT_EQ(largest(buzzed[other]), 0.0) << other;
  }
  const auto both = played(sounds, {0, 1});
  EXPECT_NEAR(largest(both[0]), 0.1 * std::numbers::sqrt2, 1e-3);
  EXPECT_EQ(both[0], both[1]) << "the loudspeakers";
  EXPECT_EQ(largest(both[2]), 0.0);
  EXPECT_NEAR(largest(both[3]), 0.5, 1e-3);
}

}  // namespace
}  // namespace haptrial::sound
