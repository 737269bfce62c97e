#include "core/base/one_processor.h"

#include <gtest/gtest.h>

#include <thread>

namespace haptrial {
namespace {

/// Processors on which the calling thread may run.
cpu_set_t allowed() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return set;
}

TEST(OneProcessorTest, AThreadAndThoseItStartsStayOnOneUntilItEnds) {
  const cpu_set_t before = allowed();
  {
    const OneProcessor beside;
    const cpu_set_t own = allowed();
    EXPECT_EQ(CPU_COUNT(&own), 1);
    cpu_set_t started{};
    std::thread([&started] { started = allowed(); }).join();
    EXPECT_TRUE(CPU_EQUAL(&own, &started));
  }
  const cpu_set_t after = allowed();
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

}  // namespace
}  // namespace haptrial
