#include <gtest/gtest.h>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/timed_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

TEST(RealClockTest, AsManyRecordsAsPeriods) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kTicks = 3000;
  const test::TimedSession session = test::run_timed_session(kTicks, folder / "S01.h5");
  const record::SessionReader reader(folder / "S01.h5");
  EXPECT_EQ(session.ticks, kTicks);
  EXPECT_EQ(session.dropped, 0u);
  EXPECT_EQ(reader.sample_count(), kTicks);
  EXPECT_EQ(record::check_session(reader).gaps, 0u);
  EXPECT_EQ(session.timing.lateness.count(), kTicks);
  EXPECT_GE(session.seconds, 2.9) << "the loop does not run ahead of the clock";
}

TEST(RealClockTest, TimesInTheFileFollowTheClock) {
  const test::TemporaryFolder folder;
  const test::TimedSession session = test::run_timed_session(500, folder / "S01.h5");
  const auto samples = record::SessionReader(folder / "S01.h5").samples(0, 500);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT(samples[i].time_ns, samples[i - 1].time_ns);
  }
  EXPECT_GE(samples.back().time_ns, 498'000'000);
  EXPECT_LT(samples.back().time_ns, static_cast<std::int64_t>(1e9 * session.seconds));
}

}  // namespace
}  // namespace haptrial
