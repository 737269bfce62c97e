// Sessions on the real clock with an Inverse3 whose Inverse Service is a stand-in.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/bone/record/drilling_tables.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/free_port.h"
#include "tests/support/haply_service.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using record::PassStatus;
using test::CommandResult;
using test::ConsolePerson;
using test::Failure;
using test::HaplyService;
using test::LiveCommand;
using testing::HasSubstr;

/// A hand that lets itself be led to the sides and keeps its height, as in a haptic trial.
void led_hand(test::StandInHandle& handle, double /*seconds*/) {
  for (const std::size_t i : {0u, 1u}) {
    handle.anchor[i] += 0.02 * (handle.position[i] - handle.anchor[i]);
  }
  handle.anchor[2] -= 0.01 * handle.position[2];  // the service's z is up
}

class LiveHaplyTest : public testing::Test {
 protected:
  LiveHaplyTest() { service_->set_hand(led_hand); }
  /// Two brisk trials of the force study, led softly enough for a device that is some ticks away.
  void write_study(std::vector<std::pair<std::string, std::string>> more = {}) const {
    more.insert(more.end(), {{"conditions", "conditions = [\"haptic\"]"},
                             {"repetitions", "repetitions = 1"},
                             {"break_after", "break_after = 0"},
                             {"settle_distance", "settle_distance = 0.02"},
                             {"trajectory", "trajectory = { stiffness = 600.0, damping = 15.0 }"},
                             {"plane", "plane = { stiffness = 600.0, damping = 15.0 }"}});
    test::write_text(folder_ / "study.toml", test::brisk_text(std::move(more)) + service_->table());
  }
  std::string run(const std::string& more = "--trials 2") const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' --device haply " + more;
  }
  fs::path file() const { return folder_ / "out/S01.h5"; }
  fs::path partial() const { return folder_ / "out/S01.h5.partial"; }
  static void expect_whole(const record::SessionReader& reader) {
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
    EXPECT_THAT(reader.info().device, HasSubstr("haply"));
    EXPECT_FALSE(reader.info().simulated);
  }

  test::TemporaryFolder folder_;
  // As fast as a busy machine still answers within a tick.
  std::unique_ptr<HaplyService> service_ =
      std::make_unique<HaplyService>(HaplyService::Options{.rate = 1000.0});
};

TEST_F(LiveHaplyTest, AForceStudyRunsToItsEnd) {
  write_study();
  const CommandResult ended = LiveCommand(run()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(" 0 lost records"));
  const record::SessionReader reader(file());
  expect_whole(reader);
  double path = 0.0;
  double force = 0.0;
  const auto samples = reader.samples(0, reader.sample_count());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    path += (samples[i].position - samples[i - 1].position).norm();
    force = std::max(force, samples[i].force.norm());
  }
  EXPECT_GT(path, 0.05) << "the device led the hand";
  EXPECT_GT(force, 0.5);
}

TEST_F(LiveHaplyTest, AServiceThatIsKilledEndsTheSessionAndAResumeFinishesIt) {
  write_study();
  LiveCommand session(run());
  ASSERT_TRUE(session.reaches([&] { return service_->force_size() > 0.3; })) << session.errors();
  const int port = service_->port();
  service_->kill();
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.errors, HasSubstr("the connection to the Inverse Service ended"));
  EXPECT_THAT(ended.errors, HasSubstr("; continue with --resume"));
  ASSERT_TRUE(fs::exists(partial()));
  {
    const record::SessionReader reader(partial());
    const auto samples = reader.samples(0, reader.sample_count());
    ASSERT_FALSE(samples.empty());
    EXPECT_TRUE(samples.back().force.isZero(0.0)) << "the force that was commanded last";
  }
  const CommandResult alone = LiveCommand(run("--trials 2 --resume")).wait();
  EXPECT_EQ(alone.status, 1) << "nobody started the service";
  EXPECT_THAT(alone.errors, HasSubstr("no Haply Inverse Service answers on port"));
  service_ = std::make_unique<HaplyService>(HaplyService::Options{.rate = 1000.0, .port = port});
  service_->set_hand(led_hand);
  const CommandResult resumed = LiveCommand(run("--trials 2 --resume")).wait();
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  const record::SessionReader reader(file());
  expect_whole(reader);
  const auto passes = reader.passes();
  EXPECT_TRUE(std::any_of(passes.begin(), passes.end(),
                          [](const auto& pass) { return pass.status == PassStatus::kAborted; }));
  EXPECT_EQ(passes.back().status, PassStatus::kCompleted);
}

TEST_F(LiveHaplyTest, AFaultStaysUntilAPersonClearsIt) {
  write_study({{"speed", "speed = 0.002"}});
  LiveCommand session(run("--console"));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(session.reaches([&] { return service_->force_size() > 0.3; })) << session.errors();
  service_->fail(Failure::kMalformed);
  ASSERT_TRUE(person.sees("stopped")) << session.errors();
  EXPECT_THAT(person.status()["fault"].get<std::string>(), HasSubstr("did not answer"));
  service_->fail(Failure::kNone);
  EXPECT_EQ(service_->force_size(), 0.0);
  EXPECT_FALSE(person.sees_within(1.5, "running"));
  ASSERT_TRUE(person.ask("clear"));
  ASSERT_TRUE(person.sees("paused")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running")) << session.errors();
  ASSERT_TRUE(session.reaches([&] { return service_->force_size() > 0.1; }));
  ASSERT_TRUE(person.ask("abort"));
  session.wait();
}

/// A hand that draws the burr to and fro over the bone, lets it sink in and lifts it again, so that
/// it cuts whenever the session begins.
void drilling_hand(test::StandInHandle& handle, double seconds) {
  const double way = 0.004 * std::sin(2.0 * seconds);  // to the right [m]
  const double depth = 0.01 * (1.0 - std::cos(2.5 * seconds));
  handle.anchor = {way, 0.0, 0.012 - depth};
  handle.buttons = 1;  // power
}

TEST_F(LiveHaplyTest, ADrillingRunsToItsEnd) {
  test::write_small_drilling(folder_.path(), 6.0);
  test::write_text(folder_ / "study.toml",
                   test::read_text(folder_ / "study.toml") + service_->table());
  service_->set_hand(drilling_hand);
  const CommandResult ended = LiveCommand(run("")).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const record::SessionReader reader(file());
  expect_whole(reader);
  EXPECT_GT(reader.count<record::RemovalRow>(), 5u) << "the burr cut";
}

TEST_F(LiveHaplyTest, TheDeviceIsTestedByItsOwnCommand) {
  write_study();
  service_->set_hand([](test::StandInHandle& handle, double seconds) {
    const double sweep = (seconds - 0.8) / 1.6;
    handle.anchor = {};
    if (sweep > 0.0 && sweep < 1.0) {
      const auto axis = static_cast<std::size_t>(3.0 * sweep);
      handle.anchor[axis] =
          0.1 * std::sin(2.0 * std::numbers::pi * (3.0 * sweep - static_cast<double>(axis)));
    }
    handle.buttons = seconds > 3.4 ? 1u : 0u;
  });
  const CommandResult result =
      test::run_command("haptrial device-test haply --seconds 4 --definition '" +
                        (folder_ / "study.toml").string() + "'");
  EXPECT_THAT(result.output, HasSubstr("Haply inverse3 049D (right-handed)"));
  EXPECT_THAT(result.output, HasSubstr("verdict: haply")) << result.errors;
  service_->kill();
  const CommandResult gone = test::run_command("haptrial device-test haply --definition '" +
                                               (folder_ / "study.toml").string() + "'");
  EXPECT_EQ(gone.status, 1);
  EXPECT_THAT(gone.errors, HasSubstr("no Haply Inverse Service answers"));
}

}  // namespace
}  // namespace haptrial
