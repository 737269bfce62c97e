#include "core/stream/stream_rows.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/device_rows.h"
#include "tests/support/stand_in_lsl.h"

namespace haptrial::stream {
namespace {

using testing::ElementsAre;

/// Rows of /devices, three a tick, on a stream of two channels.
SideStream two_channels() {
  SideStream side{"others", "Position", "m", {"x", "y"}, 3000.0, {}, {}};
  side.read = reads_rows<record::DeviceRow>([](const record::DeviceRow& row) {
    return SideSample{row.sequence, static_cast<double>(row.device) / 3000.0,
                      std::span<const double>(row.position.data(), 3)};
  });
  return side;
}

record::DeviceRow row(std::uint64_t sequence, std::int32_t place, double x) {
  record::DeviceRow made;
  made.sequence = sequence;
  made.device = place;
  made.position = {x, x + 0.5, 99.0};
  return made;
}

record::Sample sample(std::uint64_t sequence) {
  record::Sample made;
  made.sequence = sequence;
  made.time_ns = static_cast<std::int64_t>(sequence) * 1'000'000;
  return made;
}

class StreamRowsTest : public testing::Test {
 protected:
  StreamRowsTest() : library_(dlopen(HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so", RTLD_NOW)) {
    record_ = reinterpret_cast<test::LslRecord* (*)()>(dlsym(library_, "stand_in_lsl"))();
    *record_ = {};
    LslOptions options;
    options.library = HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so";
    options.sides = {two_channels()};
    outlet_ = std::make_unique<LslOutlet>(options, [] { return std::int64_t{0}; });
    rows_.emplace(outlet_.get(), two_channels(), 0);
  }
  ~StreamRowsTest() override {
    outlet_.reset();
    dlclose(library_);
  }
  void add(const std::vector<record::DeviceRow>& rows) {
    rows_->add(record::Rows(std::span<const record::DeviceRow>(rows)));
  }
  const test::LslStream& sent() const { return record_->streams.at(2); }

  void* library_;
  test::LslRecord* record_;
  std::unique_ptr<LslOutlet> outlet_;
  std::optional<StreamRows> rows_;
};

TEST_F(StreamRowsTest, RowsWaitForTheSamplesOfTheirTicks) {
  add({row(10, 0, 1.0), row(10, 1, 2.0), row(11, 0, 3.0), row(12, 0, 4.0)});
  EXPECT_TRUE(sent().values.empty()) << "nobody knows yet when they were";
  rows_->follow(std::vector{sample(9), sample(10), sample(11)});
  EXPECT_THAT(sent().values, ElementsAre(1.0, 1.5, 2.0, 2.5, 3.0, 3.5));
  ASSERT_EQ(sent().timestamps.size(), 3u);
  EXPECT_NEAR(sent().timestamps[1] - sent().timestamps[0], 1.0 / 3000.0, 1e-12);
  EXPECT_NEAR(sent().timestamps[2] - sent().timestamps[0], 0.001, 1e-12);
  add({row(12, 1, 5.0)});
  rows_->follow(std::vector{sample(12)});
  EXPECT_EQ(sent().values.size(), 10u) << "the one that had waited, and a new one";
  EXPECT_EQ(sent().values.back(), 5.5);
}

TEST_F(StreamRowsTest, ARowWhoseTickWasLostIsLeftOut) {
  add({row(10, 0, 1.0), row(11, 0, 2.0), row(12, 0, 3.0)});
  rows_->follow(std::vector{sample(10), sample(12)});
  EXPECT_THAT(sent().values, ElementsAre(1.0, 1.5, 3.0, 3.5));
}

TEST_F(StreamRowsTest, RowsOfOtherTablesAreNotItsOwn) {
  const std::vector<record::ResponseRow> answers(2);
  rows_->add(record::Rows(std::span<const record::ResponseRow>(answers)));
  rows_->follow(std::vector{sample(0), sample(1)});
  EXPECT_TRUE(sent().values.empty());
}

TEST(StreamRowsWithoutALayerTest, NothingIsKept) {
  StreamRows rows(nullptr, two_channels(), 0);
  const std::vector<record::DeviceRow> some{row(1, 0, 1.0)};
  rows.add(record::Rows(std::span<const record::DeviceRow>(some)));
  rows.follow(std::vector{sample(1)});  // would push to no outlet
}

}  // namespace
}  // namespace haptrial::stream
