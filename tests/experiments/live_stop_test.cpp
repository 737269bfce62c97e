// Force when a session is stopped, ended or killed, or when its device fails: `haptrial run` drives
// the stand-in of an omega.3, which keeps every force that it is given.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/force_log.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/stand_in.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::Commanded;
using test::CommandResult;
using test::ConsolePerson;
using test::Failure;
using test::LiveCommand;
using testing::HasSubstr;

constexpr double kPulls = 2.0;  // a force that counts as one [N]

class LiveStopTest : public testing::Test {
 protected:
  /// Passes of a slow run, in which the handle's spring pulls for long.
  static std::string study() {
    return test::brisk_text({{"conditions", "conditions = [\"haptic\"]"},
                             {"repetitions", "repetitions = 1"},
                             {"break_after", "break_after = 0"},
                             {"full_screen", "full_screen = false"},
                             {"width", "width = 600"},
                             {"height", "height = 440"},
                             {"photodiode", "photodiode = \"off\""},
                             {"settle_distance", "settle_distance = 0.02"},
                             {"speed", "speed = 0.002"},
                             {"trajectory", "trajectory = { stiffness = 900.0, damping = 20.0 }"},
                             {"plane", "plane = { stiffness = 900.0, damping = 20.0 }"}});
  }
  LiveStopTest() { test::write_text(folder_ / "study.toml", study()); }

  std::string run(const std::string& more = "--console", const std::string& out = "out") const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / out).string() + "' --device force-dimension --library '" +
           HAPTRIAL_BINARY_DIR "/libstand_in_dhd.so' " + more;
  }
  std::string environment(Failure failure = Failure::kNone) const {
    std::string lines = "export STAND_IN_FORCES='" + (folder_ / "forces").string() + "'";
    if (failure != Failure::kNone) {
      lines += "\nexport STAND_IN_FAILURE=" + std::to_string(static_cast<int>(failure)) +
               " STAND_IN_FAILURE_FORCE=" + std::to_string(kPulls);
    }
    return lines;
  }
  std::vector<Commanded> forces() const { return test::read_force_log(folder_ / "forces"); }
  bool pulls(LiveCommand& session) const {
    return session.reaches([this] {
      const auto all = forces();
      return !all.empty() && all.back().force > kPulls;
    });
  }
  static void start(ConsolePerson& person) {
    ASSERT_TRUE(person.sees("instructions"));
    ASSERT_TRUE(person.ask("start"));
  }
  /// Expects that the force went to zero in one tick, and stayed there: the last one is no fading
  /// one, which would be a small part of what it was ten commands before.
  void expect_cut() const {
    const auto all = forces();
    const auto last = std::find_if(all.rbegin(), all.rend(),
                                   [](const Commanded& each) { return each.force > 0.0; });
    ASSERT_GT(std::distance(last, all.rend()), 10);
    EXPECT_NE(last, all.rbegin()) << "the last command of all is " << all.back().force << " N";
    EXPECT_GT(last->force, 0.1);
    for (auto each = last + 1; each != last + 11; ++each) {
      EXPECT_GT(last->force, 0.8 * each->force);
    }
  }
  /// Expects that the force faded to zero, and stayed there.
  void expect_fade() const {
    const auto all = forces();
    ASSERT_GT(all.size(), 1u);
    EXPECT_EQ(all.back().force, 0.0);
    double step = 0.0;
    double highest = 0.0;
    for (std::size_t i = all.size() > 300 ? all.size() - 300 : 1; i < all.size(); ++i) {
      step = std::max(step, all[i - 1].force - all[i].force);
      highest = std::max(highest, all[i - 1].force);
    }
    EXPECT_GT(highest, kPulls);
    EXPECT_LT(step, 0.25) << "the envelope lets it go over 200 ticks";
  }

  test::TemporaryFolder folder_;
};

TEST_F(LiveStopTest, AbortLetsTheForceFade) {
  LiveCommand session(run(), environment());
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(start(person)) << session.errors();
  ASSERT_TRUE(pulls(session));
  ASSERT_TRUE(person.ask("abort"));
  session.wait();
  expect_fade();
}

TEST_F(LiveStopTest, AnEmergencyStopIsInTheDeviceWhenThePageHasItsAnswer) {
  LiveCommand session(run(), environment());
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(start(person)) << session.errors();
  ASSERT_TRUE(pulls(session));
  ASSERT_TRUE(person.ask("emergency_stop"));
  ASSERT_TRUE(person.sees("stopped"));
  ASSERT_NO_FATAL_FAILURE(expect_cut());
  EXPECT_THAT(person.status()["screen"].get<std::string>(), HasSubstr("Stopped"));
}

/// A device that fails in mid-pass, and what the sentence says.
struct Trouble {
  const char* name;
  Failure failure;
  const char* sentence;
};

class LiveFaultTest : public LiveStopTest, public testing::WithParamInterface<Trouble> {};

TEST_P(LiveFaultTest, EndsASessionThatNobodyAttends) {
  LiveCommand session(run(""), environment(GetParam().failure));
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.errors, HasSubstr(GetParam().sentence));
  EXPECT_THAT(ended.errors, HasSubstr("; continue with --resume"));
  EXPECT_TRUE(fs::exists(folder_ / "out/S01.h5.partial"));
  if (GetParam().failure != Failure::kLostLink) {  // there the device hears of no zero
    expect_cut();
  }
}

TEST_P(LiveFaultTest, StaysUntilAPersonClearsIt) {
  LiveCommand session(run(), environment(GetParam().failure));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(start(person)) << session.errors();
  ASSERT_TRUE(person.sees("stopped")) << session.errors();
  const auto before = forces().size();
  // Longer than `recovery`, 0.3 s here.
  EXPECT_FALSE(person.sees_within(1.5, "running"));
  const auto all = forces();
  for (std::size_t i = before; i < all.size(); ++i) {
    ASSERT_EQ(all[i].force, 0.0) << i;
  }
  EXPECT_THAT(person.status()["fault"].get<std::string>(), HasSubstr(GetParam().sentence));
  ASSERT_TRUE(person.ask("abort"));
  EXPECT_THAT(session.wait().output,
              testing::AllOf(HasSubstr("STOPPED in trial 1: "), HasSubstr(GetParam().sentence)));
}

std::string name_of_trouble(const testing::TestParamInfo<Trouble>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(All, LiveFaultTest,
                         testing::Values(Trouble{"LostLink", Failure::kLostLink, "did not answer"},
                                         Trouble{"NotFinite", Failure::kNotFinite, "not a number"},
                                         Trouble{"Jump", Failure::kJump, "jumped"},
                                         Trouble{"MotorsOff", Failure::kForcesOffByVelocity,
                                                 "motors off"},
                                         Trouble{"StopButton", Failure::kButton, "stop button"}),
                         name_of_trouble);

TEST_F(LiveStopTest, ALibraryThatHangsEndsTheSessionWithASentence) {
  for (const char* how : {"", "--console"}) {
    const std::string out = std::string("hangs") + how;
    LiveCommand session(run(how, out), environment(Failure::kHang));
    if (*how != '\0') {
      ConsolePerson person(session.line_after("console: "));
      ASSERT_NO_FATAL_FAILURE(start(person)) << session.errors();
    }
    const CommandResult ended = session.wait();
    EXPECT_EQ(ended.status, 1) << how;
    EXPECT_THAT(ended.errors, HasSubstr("does not come back")) << how;
    EXPECT_THAT(ended.errors, HasSubstr("; continue with --resume")) << how;
    EXPECT_TRUE(fs::exists(folder_ / out / "S01.h5.partial"));
  }
}

/// A signal, and whether the session ends by itself then.
class LiveSignalTest : public LiveStopTest, public testing::WithParamInterface<int> {};

TEST_P(LiveSignalTest, TheForceIsZeroBeforeTheProgramDies) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "sanitizers take these signals themselves";
  }
  LiveCommand session(run(""), environment());
  ASSERT_TRUE(pulls(session)) << session.errors();
  session.signal(GetParam());
  const CommandResult ended = session.wait();
  EXPECT_NE(ended.status, 0);
  expect_cut();
}

std::string name_of_signal(const testing::TestParamInfo<int>& info) {
  return ::sigabbrev_np(info.param);
}
INSTANTIATE_TEST_SUITE_P(All, LiveSignalTest,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT, SIGSEGV, SIGBUS,
                                         SIGFPE, SIGILL, SIGUSR1, SIGALRM, SIGXCPU),
                         name_of_signal);

TEST_F(LiveStopTest, ASecondSignalInTheSameInstantDoesNotKeepTheForce) {
  for (int i = 0; i < 3; ++i) {
    LiveCommand session(run("", "out" + std::to_string(i)), environment());
    ASSERT_TRUE(pulls(session)) << session.errors();
    session.signal(SIGTERM);
    session.signal(SIGTERM);
    session.wait();
    expect_cut();
  }
}

TEST_F(LiveStopTest, AServoThreadThatCrashesTakesItsForceAlong) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "sanitizers take this signal themselves";
  }
  LiveCommand session(run(""), environment(Failure::kCrash));
  EXPECT_EQ(session.wait().status, 128 + SIGSEGV);
  expect_cut();
}

TEST_F(LiveStopTest, ADisplayThatEndsLeavesNoForce) {
  test::VirtualDisplay display(640, 480);
  LiveCommand session(run("--window"), environment());
  ASSERT_TRUE(session.reaches([&] {
    display.try_key("haptrial", test::VirtualDisplay::kEnter);
    const auto all = forces();
    return !all.empty() && all.back().force > kPulls;
  })) << session.errors();
  display.end();
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.output, HasSubstr("the display is gone"));
  EXPECT_THAT(ended.errors, HasSubstr("; continue with --resume"));
  EXPECT_TRUE(fs::exists(folder_ / "out/S01.h5.partial"));
  expect_cut();
}

TEST_F(LiveStopTest, ASuspendedProgramLeavesNoForce) {
  LiveCommand session(run(""), environment());
  ASSERT_TRUE(pulls(session)) << session.errors();
  session.signal(SIGTSTP);
  test::wait_until([this] { return forces().back().force == 0.0; });
  session.signal(SIGCONT);
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.errors, HasSubstr("emergency stop"));
  expect_cut();
}

TEST_F(LiveStopTest, AReaderThatLeavesKillsNoSession) {
  LiveCommand session(run(""), environment());
  ASSERT_TRUE(pulls(session)) << session.errors();
  session.signal(SIGPIPE);
  EXPECT_TRUE(pulls(session));
  EXPECT_TRUE(session.runs());
}

TEST_F(LiveStopTest, AKeyboardThatNobodySitsAtIsRefused) {
  LiveCommand session(run("--keyboard"), environment());
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("--keyboard needs a terminal"));
  EXPECT_FALSE(fs::exists(folder_ / "out/S01.h5.partial"));
}

}  // namespace
}  // namespace haptrial
