#include "analysis/document/recorded_times.h"

#include <gtest/gtest.h>

namespace haptrial::analysis {
namespace {

TEST(RecordedTimesTest, MillisecondsThatAreReadAsSecondsAreImplausible) {
  for (const double rate : {50.0, 100.0, 1000.0, 5000.0}) {
    for (const double duration : {1.0, 6.0, 120.0}) {
      const RecordedTimes seconds{duration, rate};
      EXPECT_FALSE(seconds.implausible()) << seconds.words();
      const RecordedTimes milliseconds{1e3 * duration, 1e-3 * rate};
      EXPECT_TRUE(milliseconds.implausible()) << milliseconds.words();
    }
  }
  EXPECT_EQ((RecordedTimes{6000.0, 0.1}).words(), "6000 s with 0.1000 rows a second");
}

}  // namespace
}  // namespace haptrial::analysis
