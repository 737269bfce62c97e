#include <gtest/gtest.h>
#include <time.h>

#include <cstdio>
#include <thread>

#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::session_speed_test {
namespace {

double clock_seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Million rows for each second of processor time of this thread (the machine may be shared).
template <typename Action>
double rate(double rows, Action action) {
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  action();
  return 1e-6 * rows / (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
}

void write(const std::filesystem::path& file, const std::vector<Sample>& samples) {
  SessionWriter writer(file, test::example_info());
  constexpr std::size_t kBatch = 1000;
  for (std::size_t at = 0; at < samples.size(); at += kBatch) {
    writer.append(std::span(samples).subspan(at, kBatch));
  }
  writer.close();
}

TEST(SessionSpeedTest, AParticipantFitsInSixtyMegabytes) {
  constexpr std::size_t kRows = 1800000;
  const test::TemporaryFolder folder;
  const std::vector<Sample> samples = test::hand_motion(kRows, 1);
  const double writing = rate(kRows, [&] { write(folder / "a.h5", samples); });
  const auto size = std::filesystem::file_size(folder / "a.h5");
  const SessionReader reader(folder / "a.h5");
  std::vector<Sample> back;
  const double reading = rate(kRows, [&] { back = reader.samples(0, kRows); });
  SampleColumns columns;
  const double column_reading = rate(kRows, [&] { columns = reader.columns(0, kRows); });

  const double start = clock_seconds(CLOCK_MONOTONIC);
  {
    std::jthread first([&] { write(folder / "b.h5", samples); });
    std::jthread second([&] { write(folder / "c.h5", samples); });
  }
  const double two = 2e-6 * kRows / (clock_seconds(CLOCK_MONOTONIC) - start);
  std::printf("%zu rows: %.1f MB, %.1f bytes a row\n", kRows, 1e-6 * static_cast<double>(size),
              static_cast<double>(size) / kRows);
  std::printf(
      "million rows/s: write %.1f, read %.1f, read columns %.1f (processor time); two "
      "sessions in two threads %.1f (wall clock)\n",
      writing, reading, column_reading, two);

  EXPECT_LT(size, 60000000u);
  ASSERT_EQ(back.size(), kRows);
  ASSERT_EQ(columns.time_ns.size(), kRows);
  for (std::size_t i = 0; i < kRows; i += 997) {
    ASSERT_TRUE(test::same(back[i], test::on_file(samples[i]))) << "row " << i;
  }
}

}  // namespace
}  // namespace haptrial::record::session_speed_test
