#include "experiments/control/signals.h"

#include <gtest/gtest.h>

#include <csignal>

namespace haptrial::experiments {
namespace {

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
