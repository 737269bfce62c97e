#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

/// A servo thread that stops when it has been looked at so often, or never.
struct FakeServo final : FatalStopHandler {
  explicit FakeServo(int looks, bool itself = false) : looks_left(looks), is_servo(itself) {}
  void ask() noexcept override { asked = true; }
  bool done() const noexcept override {
    ++looked;
    return asked && looks_left >= 0 && looks_left-- == 0;
  }
  bool on_servo_thread() const noexcept override { return is_servo; }
  void write_zero() noexcept override { ++written; }

  mutable int looked{0};
  mutable int looks_left;
  bool is_servo;
  bool asked{false};
  int written{0};
  const WatchedStop watched{*this};
};

TEST(FatalStopHandlerTest, TheServoThreadWritesTheZeroWhereItStillRuns) {
  FakeServo servo(3);
  take_force_away();
  EXPECT_TRUE(servo.asked);
  EXPECT_EQ(servo.written, 0) << "the library is called from one thread only";
}

TEST(FatalStopHandlerTest, AServoThreadThatHangsIsWaitedForABoundedTime) {
  FakeServo servo(-1);
  take_force_away();
  EXPECT_EQ(servo.written, 1);
  EXPECT_GT(servo.looked, 0);
  EXPECT_LE(servo.looked, 1000) << "it is looked at five times a millisecond";
}

TEST(FatalStopHandlerTest, AServoThreadThatDiesDoesNotWaitForItself) {
  FakeServo servo(-1, true);
  take_force_away();
  EXPECT_EQ(servo.written, 1);
  EXPECT_EQ(servo.looks_left, -1);
}

/// A servo thread that hangs, on a device that says when it is given zero.
struct HeardServo final : FatalStopHandler {
  void ask() noexcept override {}
  bool done() const noexcept override { return false; }
  bool on_servo_thread() const noexcept override { return false; }
  void write_zero() noexcept override { std::fputs("zero", stderr); }
  const WatchedStop watched{*this};
};

TEST(FatalStopHandlerDeathTest, ALibraryThatEndsTheProgramTakesTheForceAway) {
  EXPECT_EXIT(
      {
        HeardServo servo;
        std::exit(3);
      },
      testing::ExitedWithCode(3), "^zero$");
  EXPECT_EXIT(
      {
        { HeardServo servo; }
        std::exit(3);
      },
      testing::ExitedWithCode(3), "^$")
      << "its session had ended";
}

TEST(FatalStopHandlerTest, WithoutASessionThereIsNothingToDo) { take_force_away(); }

auto handler_of(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return now.sa_handler;
}

TEST(SignalsTest, WorkAfterAWatchIsEndedBySignalsAgain) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = handler_of(signal);
    {
      const InterruptWatch watch;
      EXPECT_NE(handler_of(signal), before);
      { const InterruptWatch inner; }
      EXPECT_NE(handler_of(signal), before) << "the outer work is watched still";
    }
    EXPECT_EQ(handler_of(signal), before);
  }
}

}  // namespace
}  // namespace haptrial::experiments
