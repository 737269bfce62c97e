#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_robotiq.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::channel {
namespace {

using test::ChannelRun;
using test::robotiq_frame;
using test::StandInRobotiq;
using ::testing::HasSubstr;

std::string robotiq_keys(const std::string& path) {
  return fmt::format("[channels.sensor]\nkind = 'robotiq'\npath = '{}'\n", path);
}

TEST(RobotiqChannelTest, TheStandInHasTheChecksumOfModbus) {
  EXPECT_EQ(test::modbus_checksum("123456789"), "\x37\x4B") << "the check value of CRC-16/MODBUS";
}

TEST(RobotiqChannelTest, ValuesAreRightToTheLastCount) {
  StandInRobotiq sensor;
  ChannelRun run(robotiq_keys(sensor.line().name()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  test::wait_until([&] { return sensor.starts() == 1; });
  EXPECT_EQ(sensor.jammed(), 50u) << "a stream that runs is stopped first";
  RandomStream random(5, "counts");
  std::vector<std::array<std::int16_t, 6>> sent{{std::numeric_limits<std::int16_t>::min(),
                                                 std::numeric_limits<std::int16_t>::max(), -1, 1, 0,
                                                 0x4E20}};
  for (int i = 0; i < 200; ++i) {
    std::array<std::int16_t, 6> counts{};
    for (std::int16_t& each : counts) {
      each = static_cast<std::int16_t>(random.uniform() * 65535.0 - 32768.0);
    }
    sent.push_back(counts);
  }
  for (const auto& counts : sent) {
    sensor.line().send(robotiq_frame(counts));
  }
  const auto& rows = run.rows(sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(std::llround(rows[i].values[k] * (k < 3 ? 100.0 : 1000.0)), sent[i][k]);
    }
  }
  EXPECT_TRUE(run.of_kind(Incident::kMalformed).empty());
  run.close();
  test::wait_until([&] { return sensor.jammed() == 100u; });  // which stops it
}

TEST(RobotiqChannelTest, RubbishBetweenFramesIsCountedAndPassedOver) {
  StandInRobotiq sensor;
  ChannelRun run(robotiq_keys(sensor.line().name()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const std::string good = robotiq_frame({100, 200, 300, 1000, 2000, 3000});
  std::string damaged = good;
  damaged[7] = static_cast<char>(damaged[7] ^ 0x10);
  const std::string cut = good.substr(0, 9);
  sensor.line().send("\x20\x4E\x20" + good);  // what may be the head of a frame, and is not
  sensor.line().send(damaged + good);
  sensor.line().send(cut + good);
  run.rows(3);
  sensor.line().send(cut);  // the rest comes later
  EXPECT_FALSE(test::happens_within(0.05, [&] { return run.rows(3).size() > 3; }));
  sensor.line().send(good.substr(9));
  for (const ChannelRow& row : run.rows(4)) {
    EXPECT_EQ(row.values[0], 1.0);
    EXPECT_EQ(row.values[5], 3.0);
  }
  test::wait_until([&] { return run.amount(Incident::kMalformed) >= 3.0 + 16.0 + 9.0; });
  EXPECT_EQ(run.amount(Incident::kMalformed), 28.0);
}

TEST(RobotiqChannelTest, ALineThatIsUnpluggedIsOpenedAnew) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "sensor";
  std::optional<StandInRobotiq> sensor(std::in_place);
  std::filesystem::create_symlink(sensor->line().name(), path);
  ChannelRun run(robotiq_keys(path.string()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const std::string frame = robotiq_frame({1, 2, 3, 4, 5, 6});
  sensor->line().send(frame);
  run.rows(1);
  std::filesystem::remove(path);
  sensor->line().unplug();
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text,
              HasSubstr("Robotiq sensor at " + path.string()));
  EXPECT_FALSE(run.channel().seen().live);
  sensor.emplace();
  std::filesystem::create_symlink(sensor->line().name(), path);
  test::wait_until([&] { return sensor->starts() == 1; });
  sensor->line().send(frame);
  EXPECT_EQ(run.incidents(Incident::kBack, 1).size(), 1u);
  EXPECT_EQ(run.rows(2)[1].sample, 1u);
  EXPECT_TRUE(run.channel().seen().live);
}

TEST(RobotiqChannelTest, ASensorThatFallsSilentIsLostAndBack) {
  StandInRobotiq sensor;
  ChannelRun run(robotiq_keys(sensor.line().name()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const std::string frame = robotiq_frame({1, 2, 3, 4, 5, 6});
  sensor.line().send(frame);
  run.rows(1);
  run.set_now(5.0);  // beyond the patience of 1 s
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("no data come"));
  sensor.line().send(frame);
  run.incidents(Incident::kBack, 1);
  EXPECT_TRUE(run.channel().seen().live);
}

TEST(RobotiqChannelTest, PlantedTimesAreWithinTheStatedUncertainty) {
  StandInRobotiq sensor;
  ChannelRun run(robotiq_keys(sensor.line().name()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  RandomStream random(13, "way");
  constexpr std::size_t kFrames = 3000;
  constexpr double kOnTheLine = 16.0 * 10.0 / 19200.0;  // [s]
  std::vector<double> truths;
  double came_before = 0.0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    truths.push_back(0.5 + 10e-3 * static_cast<double>(i) * (1.0 + 100e-6));
    const double came = truths.back() + kOnTheLine - 2e-3 * std::log(1.0 - random.uniform());
    came_before = std::max(came, came_before);
    run.set_now(came_before);
    sensor.line().send(robotiq_frame({1, 2, 3, 4, 5, 6}));
    run.rows(i + 1);
  }
  EXPECT_GT(test::share_within(run.rows(kFrames), truths), 0.95);
}

TEST(RobotiqChannelTest, FramesThatComeTogetherKeepTheirDistance) {
  StandInRobotiq sensor;
  ChannelRun run(robotiq_keys(sensor.line().name()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  run.set_now(2.0);
  const std::string frame = robotiq_frame({1, 2, 3, 4, 5, 6});
  sensor.line().send(frame + frame + frame);
  const auto& rows = run.rows(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double truth = 2.0 - 16.0 * 10.0 / 19200.0 - 10e-3 * static_cast<double>(2 - i);
    const double error = 1e-9 * static_cast<double>(rows[i].time_ns) - truth;
    EXPECT_LE(std::abs(error), rows[i].uncertainty) << i;
  }
}

TEST(RobotiqChannelTest, ASensorThatIsNotThereGetsASentence) {
  StandInRobotiq sensor;
  sensor.set_answering(false);
  ChannelRun silent(robotiq_keys(sensor.line().name()));
  EXPECT_EQ(silent.channel().wait_until_open(),
            "Robotiq sensor at " + sensor.line().name() + ": does not answer the request for data");
  ChannelRun none(robotiq_keys("/dev/no-such-line"));
  EXPECT_THAT(none.channel().wait_until_open(), HasSubstr("group dialout"));
  ChannelRun other(robotiq_keys("/dev/null"));
  EXPECT_THAT(other.channel().wait_until_open(), HasSubstr("no serial line"));
  EXPECT_THAT(test::message_of([] { test::channels_of("[channels.sensor]\nkind = 'robotiq'\n"); }),
              HasSubstr("channels.sensor.path"));
}

}  // namespace
}  // namespace haptrial::channel
