// Studies on boards: `haptrial run` drives simulated boards on pseudo-terminals, one of which is
// unplugged in the middle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <numbers>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/boards/simulated_board.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::board_session_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using test::HapiFirmware;
using test::PaddleFirmware;
using test::run_command;
using test::SimulatedBoard;
using testing::HasSubstr;

/// A hand that goes to and fro between the two places, and presses one button after the other.
void move(SimulatedBoard& board, double time) {
  board.mass.set_anchor({0.032 * std::sin(std::numbers::pi * time), 0.0, 0.0});
  const int tenth = static_cast<int>(10.0 * time) % 10;
  board.buttons = tenth == 2 ? 1u : tenth == 7 ? 2u : 0u;
}

class BoardSessionTest : public testing::Test {
 protected:
  /// Trials with a pull along x, along which the boards give force, and a lift along y.
  void write_study(const std::string& choices, const std::string& board) {
    std::string text = test::felt_or_not("choices = " + choices + "\n");
    const auto replace = [&text](const std::string& what, const std::string& with) {
      text.replace(text.find(what), what.size(), with);
    };
    replace("repetitions = 6", "repetitions = 1");
    replace("force = [\"$level\", 0.0, 0.0]", "force = [\"$level\", \"0.5 * $level\", 0.0]");
    // A busy machine is late with the board's answers, which is not the matter here.
    test::write_text(folder_ / "study.toml",
                     text +
                         "[envelope]\nmax_force = 3.0\nworkspace_radius = 0.05\nmax_speed = 2.0\n"
                         "holding_force = 2.0\n"
                         "max_jump = 0.1\n" +
                         board + "patience = 1.0\nstart_time = 60.0\n");
  }
  std::string run(const std::string& device) const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --seed 7 --out '" +
           (folder_ / "out").string() + "' --device " + device;
  }
  void expect_whole(const std::string& device) const {
    const record::SessionReader reader(folder_ / "out/S01.h5");
    EXPECT_EQ(reader.info().device, device);
    EXPECT_FALSE(reader.info().simulated);
    EXPECT_EQ(reader.responses().size(), 2u);
    double along = 0.0;
    double across = 0.0;
    double way = 0.0;
    for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
      along = std::max(along, sample.force.x());
      across = std::max(across, std::abs(sample.force.y()));
      way = std::max(way, std::abs(sample.position.x()));
    }
    EXPECT_GT(along, 0.9) << "the pull of 1 N";
    EXPECT_EQ(across, 0.0) << "a force that the board cannot give is not recorded as given";
    EXPECT_GT(way, 0.02);
  }

  test::TemporaryFolder folder_;
};

TEST_F(BoardSessionTest, AStudyOnAPaddleIsAnsweredWithItsButtons) {
  SimulatedBoard board(std::make_unique<PaddleFirmware>(), Vector3d::UnitX());
  board.start(0, move);
  write_study("[{ value = \"felt\", buttons = [0] }, { value = \"not\", buttons = [1] }]",
              "[paddle]\nport = \"" + board.port() +
                  "\"\ncolumns = [\"-\", \"x\", \"buttons\"]\nposition_scale = -0.001\n"
                  "position_zero = 100.0\ncommand = \"T{x}\"\nforce_scale = 0.08\n");
  const auto result = run_command("haptrial " + run("paddle"));
  EXPECT_EQ(result.status, 0) << result.output << result.errors;
  EXPECT_THAT(
      run_command("haptrial validate '" + (folder_ / "study.toml").string() + "'").output,
      HasSubstr(
          "the paddle moves and gives forces along x alone; forces along y and z are left out"));
  board.stop();
  EXPECT_EQ(board.force().norm(), 0.0);
  expect_whole("paddle");
}

/// A hand whose readings are late jumps or stands still: a fault, as it should be.
class TimedBoardSessionTest : public BoardSessionTest {};

TEST_F(TimedBoardSessionTest, ASessionOnAPantographGoesOnAfterItWasUnplugged) {
  const std::string choices =
      "[{ value = \"felt\", touch = \"right\" }, { value = \"not\", touch = \"left\" }]";
  const auto board_table = [](const SimulatedBoard& board) {
    return "[hapi]\nport = \"" + board.port() + "\"\n";
  };
  auto first = std::make_unique<SimulatedBoard>(std::make_unique<HapiFirmware>());
  first->start(0, move);
  write_study(choices, board_table(*first));
  {
    test::LiveCommand session(run("hapi"));
    ASSERT_TRUE(session.reaches([&] {
      try {
        return record::SessionReader(folder_ / "out/S01.h5.partial").sample_count() > 300;
      } catch (const std::exception&) {  // not there yet
        return false;
      }
    })) << session.errors();
    first->stop();
    first->unplug();
    const auto ended = session.wait();
    EXPECT_NE(ended.status, 0);
    EXPECT_THAT(ended.output + ended.errors, HasSubstr("serial line was lost"));
  }
  EXPECT_FALSE(fs::exists(folder_ / "out/S01.h5"));
  SimulatedBoard second(std::make_unique<HapiFirmware>());
  second.start(0, move);
  write_study(choices, board_table(second));
  const auto resumed = run_command("haptrial " + run("hapi") + " --resume");
  EXPECT_EQ(resumed.status, 0) << resumed.output << resumed.errors;
  second.stop();
  EXPECT_EQ(second.force().norm(), 0.0);
  expect_whole("hapi");
}

TEST_F(BoardSessionTest, ASessionThatIsKilledBySignalLeavesTheBoardWithoutForce) {
  for (const int signal : {SIGTERM, SIGSEGV}) {
    std::atomic<double> pull{0.0};
    SimulatedBoard board(std::make_unique<HapiFirmware>());
    board.start(0, [&pull](SimulatedBoard& pulled, double) { pull = pulled.force().x(); });
    write_study("[{ value = \"felt\" }, { value = \"not\" }]",
                "[hapi]\nport = \"" + board.port() + "\"\n");
    std::string text = test::read_text(folder_ / "study.toml");
    text.replace(text.find("levels = [0.02"), 14, "levels = [0.90");  // the first pull counts
    test::write_text(folder_ / "study.toml", text);
    fs::remove_all(folder_ / "out");
    test::LiveCommand session(run("hapi"));
    ASSERT_TRUE(session.reaches([&] { return pull > 0.5; })) << session.errors();
    session.signal(signal);
    session.wait();
    test::wait_until([&] { return pull == 0.0; });
    board.stop();
    EXPECT_EQ(board.force().norm(), 0.0);
  }
}

TEST_F(BoardSessionTest, ABoardWithoutATableIsRefused) {
  const auto refused =
      run_command("cd '" + folder_.path().string() +
                  "'; haptrial run first_experiment --subject S01 --device hapi --out '" +
                  (folder_ / "out").string() + "'");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("with a table [hapi] whose port says which serial line"));
  const auto untested = run_command("haptrial device-test paddle");
  EXPECT_EQ(untested.status, 2);
  EXPECT_THAT(untested.errors,
              HasSubstr("with a table [paddle] whose port says which serial line"));
}

TEST_F(TimedBoardSessionTest, ADeviceTestTriesTheAxesThatThereAre) {
  SimulatedBoard board(std::make_unique<HapiFirmware>(), {1.0, 0.0, 1.0});
  board.start(0, [](SimulatedBoard& moved, double time) {
    const double angle = 3.0 * time;
    moved.mass.set_anchor(time < 60.0
                              ? Vector3d(0.023 * std::cos(angle), 0.0, 0.023 * std::sin(angle))
                              : Vector3d::Zero());
  });
  write_study("[{ value = \"felt\" }, { value = \"not\" }]",
              "[hapi]\nport = \"" + board.port() + "\"\n");
  const auto result = run_command("haptrial device-test hapi --seconds 8 --definition '" +
                                  (folder_ / "study.toml").string() + "'");
  EXPECT_THAT(result.output, HasSubstr("good  workspace"));
  EXPECT_THAT(result.output, HasSubstr("y 0.0 to 0.0 mm"));
  EXPECT_THAT(result.output, HasSubstr("this device has none")) << "no button";
}

}  // namespace
}  // namespace haptrial::board_session_test
