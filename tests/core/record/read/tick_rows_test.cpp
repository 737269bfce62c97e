#include "core/record/read/tick_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/hdf5/session_writer.h"
#include "tests/core/record/session_fixture.h"
#include "tests/support/message_of.h"

namespace haptrial::record::tick_rows_test {
namespace {

using testing::HasSubstr;

/// Ticks 100 to 399, of which 200 to 249 were lost; passes of 100 ticks.
class TickRowsTest : public testing::Test {
 protected:
  TickRowsTest() {
    std::vector<Sample> samples = test::hand_motion(300, 1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].sequence = 100 + i;
      samples[i].time_ns = static_cast<std::int64_t>(100 + i) * 1'000'000;
    }
    samples.erase(samples.begin() + 100, samples.begin() + 150);
    SessionWriter writer(folder_ / "S01.h5", test::example_info());
    writer.append(samples);
    for (int trial = 1; trial <= 3; ++trial) {
      PassRow pass{trial, "haptic", Phase("test")};
      pass.first_sample = 100 * static_cast<std::uint64_t>(trial);
      pass.last_sample = pass.first_sample + 99;
      writer.add_pass(pass);
    }
    writer.close();
    reader_.emplace(folder_ / "S01.h5");
  }
  RowSpan span(std::uint64_t first, std::uint64_t count) const {
    return span_of_ticks(*reader_, samples_table(), first, count);
  }

  test::TemporaryFolder folder_;
  std::optional<SessionReader> reader_;
};

/// A row is no tick: an early loss moves all rows behind it.
TEST_F(TickRowsTest, RowsBehindALossAreThoseOfTheirTicks) {
  const auto rows = rows_of_ticks(*reader_, samples_table(), 300, 100);
  ASSERT_EQ(rows.size(), 100u);
  EXPECT_EQ(rows.front().sequence, 300u);
  EXPECT_EQ(rows.back().sequence, 399u);
  EXPECT_EQ(span(300, 100).first, 150u);
  EXPECT_EQ(span(190, 70).count, 20u) << "10 before the loss and 10 behind it";
  EXPECT_EQ(span(210, 20).count, 0u);
  EXPECT_EQ(span(0, 110).count, 10u) << "nothing was recorded before tick 100";
  EXPECT_EQ(span(390, 1000).count, 10u);
  EXPECT_EQ(span(400, 10).count, 0u);
}

TEST_F(TickRowsTest, APassIsReadWholeOrNotAtAll) {
  const std::vector<PassRow> passes = reader_->passes();
  EXPECT_EQ(samples_of_pass(*reader_, passes[0]).front().sequence, 100u);
  EXPECT_EQ(samples_of_pass(*reader_, passes[2]).front().sequence, 300u);
  EXPECT_THAT(test::message_of([&] { samples_of_pass(*reader_, passes[1]); }),
              HasSubstr("of the 100 ticks of trial 2, 50 are in the file"));
}

}  // namespace
}  // namespace haptrial::record::tick_rows_test
