// The stand-ins of instruments that docs/channels.md shows, recorded by the command.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <string>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

TEST(StandInSensorTest, ItsSineIsRecordedByItsOwnClock) {
  const test::TemporaryFolder folder;
  const int port = test::free_port();
  std::ofstream(folder / "lab.toml")
      << "[experiment]\nprotocol = \"trials\"\nname = \"sensor\"\n[design]\nparticipants = "
         "1\n[[stages]]\nname = \"wait\"\n"
         "until = { time = 1.0 }\n[[blocks]]\nname = \"one\"\ntrials = 1\n[channels.force]\n"
         "kind = \"rdt\"\nhost = \"127.0.0.1\"\nrate = 1000.0\ncounts_per_force = 1000000.0\n"
         "counts_per_torque = 1000000.0\nport = "
      << port << "\n";
  const auto result = test::run_command(
      fmt::format("cd '{}' && (/usr/bin/python3 -B "
                  "'" HAPTRIAL_SOURCE_DIR "/docs/worked/stand_in/force_sensor.py' --port {} "
                  "--amplitude 3 --frequency 0.5 > started & until grep -q listens started; do "
                  "sleep 0.05; done; haptrial record lab.toml force.h5 --seconds 1.5; "
                  "status=$?; kill $!; exit $status)",
                  folder.path().string(), port));
  ASSERT_EQ(result.status, 0) << result.errors << result.output;
  const record::SessionReader reader((folder / "force.h5").string());
  const auto table = reader.description("channel_force");
  std::size_t rows = 0;
  reader.each_row(*table, [&](const std::vector<record::Cell>& cells) {
    const double clock = std::get<double>(cells[4]);  // the sensor's own [s]
    const double fx = std::get<double>(cells[5]);
    EXPECT_NEAR(fx, 3.0 * std::sin(std::numbers::pi * clock), 0.02) << rows;
    ++rows;
  });
  EXPECT_GT(rows, 500u);
}

TEST(StandInSensorTest, ACircleIsRecordedThroughMistakesAndTheServersEnd) {
  const test::TemporaryFolder folder;
  const int port = test::free_port();
  std::ofstream(folder / "lab.toml")
      << "[experiment]\nprotocol = \"trials\"\nname = \"tracker\"\n[design]\nparticipants = "
         "1\n[[stages]]\nname = \"wait\"\nuntil = { time = 1.0 }\n[[blocks]]\nname = \"one\"\n"
         "trials = 1\n[channels.hand]\nkind = \"vrpn\"\nhost = \"127.0.0.1\"\ntracker = \"Arm\"\n"
         "port = "
      << port << "\n";
  const auto result = test::run_command(
      fmt::format("cd '{}' && (/usr/bin/python3 -B "
                  "'" HAPTRIAL_SOURCE_DIR "/docs/worked/stand_in/tracker.py' --port {} --rate 200 "
                  "--frequency 0.5 --mistakes 10 --die 300 > started & "
                  "until grep -q listens started; do sleep 0.05; done; "
                  "haptrial record lab.toml hand.h5 --seconds 4; "
                  "status=$?; kill $!; exit $status)",
                  folder.path().string(), port));
  ASSERT_EQ(result.status, 0) << result.errors << result.output;
  const record::SessionReader reader((folder / "hand.h5").string());
  std::size_t rows = 0;
  double before = 0.0;
  reader.each_row(*reader.description("channel_hand"), [&](const auto& cells) {
    const double clock = std::get<double>(cells[4]);  // the server's own [s]
    EXPECT_GT(clock, before);
    before = clock;
    const double turn = std::numbers::pi * clock;
    EXPECT_NEAR(std::get<double>(cells[5]), 0.1 * std::cos(turn), 1e-5) << rows;
    EXPECT_NEAR(std::get<double>(cells[6]), 0.1 * std::sin(turn), 1e-5) << rows;
    ++rows;
  });
  EXPECT_GT(rows, 150u);
  std::set<std::string> words;
  reader.each_row(*reader.description("channel_events"),
                  [&](const auto& cells) { words.insert(std::get<std::string>(cells[2])); });
  for (const char* word : {"repeated", "malformed", "lost", "back"}) {
    EXPECT_TRUE(words.contains(word)) << word;
  }
}

}  // namespace
}  // namespace haptrial::experiments
