#include "core/stream/lsl_outlet.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/base/error.h"
#include "tests/support/stand_in_lsl.h"

namespace haptrial::stream {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const char* const kStandIn = HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so";

class LslOutletTest : public testing::Test {
 protected:
  LslOutletTest() : library_(dlopen(kStandIn, RTLD_NOW)) {
    auto* memory = reinterpret_cast<test::LslRecord* (*)()>(dlsym(library_, "stand_in_lsl"));
    record_ = memory();
    *record_ = {};
  }
  ~LslOutletTest() override { dlclose(library_); }

  static LslOptions options() {
    return {kStandIn, "force_training", "P07", "omega.3", 1000.0, true, {}};
  }
  static record::Sample sample(std::uint64_t sequence) {
    record::Sample s;
    s.sequence = sequence;
    s.time_ns = static_cast<std::int64_t>(sequence) * 1'000'000;
    s.position = {0.01, 0.02, 0.03};
    s.velocity = {0.1, 0.2, 0.3};
    s.force = {1.0, 2.0, 3.0};
    s.applied_force = 4.0;
    s.target_force = 5.0;
    s.pass = 6;
    s.stage = record::Stage::kRun;
    s.saturated = sequence % 2 == 1;
    return s;
  }

  /// The session's clock, set by a test.
  SessionClock now() {
    return [this] { return now_ns_; };
  }

  void* library_;
  test::LslRecord* record_;
  std::int64_t now_ns_{0};
};

TEST_F(LslOutletTest, OpensASampleAndAMarkerStreamThatDescribeThemselves) {
  const LslOutlet outlet(options(), now());
  ASSERT_EQ(record_->streams.size(), 2u);
  const test::LslStream& samples = record_->streams[0];
  EXPECT_EQ(samples.name, "haptrial P07");
  EXPECT_EQ(samples.type, "Haptics");
  EXPECT_EQ(samples.rate, 1000.0);
  EXPECT_EQ(samples.format, 2) << "double precision";
  EXPECT_EQ(samples.channels, 15);
  const test::LslStream& markers = record_->streams[1];
  EXPECT_EQ(markers.type, "Markers");
  EXPECT_EQ(markers.rate, 0.0) << "irregular";
  EXPECT_EQ(markers.format, 3) << "text";
  EXPECT_EQ(markers.channels, 1);
  EXPECT_NE(samples.source_id, markers.source_id);
  EXPECT_EQ(record_->infos, 0) << "an outlet copies its description, which must be destroyed";
  for (const test::LslStream& stream : record_->streams) {
    EXPECT_THAT(stream.description, testing::Contains(Pair("subject", "P07")));
    EXPECT_THAT(stream.description, testing::Contains(Pair("study", "force_training")));
    EXPECT_THAT(stream.description, testing::Contains(Pair("simulated", "true")));
  }
  std::map<std::string, std::vector<std::string>> found;
  for (const auto& [path, value] : samples.description) {
    found[path].push_back(value);
  }
  const auto& labels = found["channels/channel/label"];
  ASSERT_EQ(labels.size(), 15u);
  EXPECT_EQ(labels[1], "position_x");
  EXPECT_EQ(found["channels/channel/unit"][1], "m");
  EXPECT_EQ(found["channels/channel/unit"][11], "N");
}

TEST_F(LslOutletTest, SamplesArriveChannelByChannelOnTheLayersClock) {
  LslOutlet outlet(options(), now());
  record_->clock = 5000.0;
  now_ns_ = 2'000'000'000;
  outlet.push(std::vector{sample(2000), sample(2001)});
  outlet.push(std::vector{sample(2002)});
  outlet.push({});
  const test::LslStream& stream = record_->streams[0];
  ASSERT_EQ(stream.values.size(), 45u);
  EXPECT_THAT(
      std::vector<double>(stream.values.begin() + 15, stream.values.begin() + 30),
      ElementsAre(2001.0, 0.01, 0.02, 0.03, 0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 3.0, 1.0));
  ASSERT_EQ(stream.timestamps.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(stream.timestamps[i], 5000.0 + 0.001 * static_cast<double>(i), 1e-9);
  }
  EXPECT_EQ(outlet.refused(), 0u);
}

TEST_F(LslOutletTest, SideStreamsStandBesideTheSamples) {
  LslOptions more = options();
  more.sides.push_back({"muscles", "EMG", "V", {"left", "right"}, 8000.0, {{"model", "made"}}, {}});
  more.sides.push_back({"grip", "Force", "N", {"grip"}, 0.0, {}, {}});
  LslOutlet outlet(more, now());
  record_->clock = 5000.0;
  now_ns_ = 2'000'000'000;
  ASSERT_EQ(record_->streams.size(), 4u);
  const test::LslStream& stream = record_->streams[2];
  EXPECT_EQ(stream.name, "haptrial P07 muscles");
  EXPECT_EQ(stream.source_id, "haptrial-force_training-P07-muscles");
  EXPECT_EQ(stream.type, "EMG");
  EXPECT_EQ(stream.rate, 8000.0);
  EXPECT_EQ(stream.channels, 2);
  EXPECT_EQ(stream.format, 2) << "double precision";
  EXPECT_THAT(stream.description, testing::Contains(Pair("channels/channel/label", "right")));
  EXPECT_THAT(stream.description, testing::Contains(Pair("channels/channel/unit", "V")));
  EXPECT_THAT(stream.description, testing::Contains(Pair("model", "made")));
  EXPECT_THAT(stream.description, testing::Contains(Pair("subject", "P07")));
  EXPECT_EQ(record_->streams[3].rate, 0.0) << "irregular";
  EXPECT_EQ(record_->infos, 0);
  outlet.push_side(0, std::vector{1e-6, 2e-6, 3e-6, 4e-6}, std::vector{2.0, 2.000125});
  outlet.push_side(1, std::vector{7.0}, std::vector{2.5});
  EXPECT_THAT(stream.values, ElementsAre(1e-6, 2e-6, 3e-6, 4e-6));
  ASSERT_EQ(stream.timestamps.size(), 2u);
  EXPECT_NEAR(stream.timestamps[1], 5000.000125, 1e-9);
  EXPECT_THAT(record_->streams[3].values, ElementsAre(7.0));
  EXPECT_NEAR(record_->streams[3].timestamps.at(0), 5000.5, 1e-9);
  outlet.push_side(2, std::vector{7.0}, std::vector{2.5});
  EXPECT_EQ(outlet.refused(), 0u) << "there is no third one";
}

TEST_F(LslOutletTest, SamplesAreNotTakenForTheMomentInWhichTheyArePushed) {
  LslOutlet outlet(options(), now());
  record_->clock = 100.0;
  now_ns_ = 0;
  outlet.mark("before the loop begins", 0);  // and 0.3 s pass until it does
  record_->clock = 100.3;
  now_ns_ = 25'000'000;  // the first push comes 5 ms after its last sample
  outlet.push(std::vector{sample(10), sample(20)});
  EXPECT_NEAR(record_->streams[1].timestamps.at(0), 100.0, 1e-9);
  EXPECT_NEAR(record_->streams[0].timestamps.at(0), 100.285, 1e-9);
  EXPECT_NEAR(record_->streams[0].timestamps.at(1), 100.295, 1e-9);
}

TEST_F(LslOutletTest, TheClocksAreComparedAgainEverySecond) {
  LslOutlet outlet(options(), now());
  record_->clock = 100.0;
  outlet.push(std::vector{sample(0)});
  record_->clock = 100.5;
  now_ns_ = 499'000'000;  // one of the clocks drifts by 2 ms a second
  outlet.push(std::vector{sample(499)});
  EXPECT_NEAR(record_->streams[0].timestamps.at(1), 100.499, 1e-9) << "not at each push";
  record_->clock = 101.0;
  now_ns_ = 998'000'000;
  outlet.push(std::vector{sample(1000)});
  EXPECT_NEAR(record_->streams[0].timestamps.at(2), 101.002, 1e-9);
}

TEST_F(LslOutletTest, AnInterruptionWhileTheClocksAreComparedIsNoShift) {
  int readings = 0;
  LslOutlet outlet(options(), [&readings] {
    ++readings;
    return readings == 2 ? std::int64_t{80'000'000} : std::int64_t{0};  // within the first one
  });
  record_->clock = 50.0;
  outlet.push(std::vector{sample(0)});
  EXPECT_NEAR(record_->streams[0].timestamps.at(0), 50.0, 1e-9);
}

TEST_F(LslOutletTest, MarkersShareTheClockOfTheSamples) {
  LslOutlet outlet(options(), now());
  record_->clock = 50.0;
  outlet.mark("trial 1 training", 1'500'000'000);
  EXPECT_THAT(record_->streams[1].texts, ElementsAre("trial 1 training"));
  EXPECT_NEAR(record_->streams[1].timestamps.at(0), 51.5, 1e-9);
}

TEST_F(LslOutletTest, RefusedPushesAreCountedAndTheFirstOneIsKept) {
  LslOutlet outlet(options(), now());
  record_->push_result = -4;
  outlet.push(std::vector{sample(1), sample(2), sample(3)});
  outlet.mark("lost", 0);
  EXPECT_EQ(outlet.refused(), 4u);
  EXPECT_EQ(outlet.first_refusal(), "error -4: the stand-in was told to fail");
  record_->push_result = 0;
  outlet.push(std::vector{sample(4)});
  EXPECT_EQ(outlet.refused(), 4u);
}

TEST_F(LslOutletTest, ClosesItsStreams) {
  {
    const LslOutlet outlet(options(), now());
    EXPECT_TRUE(record_->streams[0].open && record_->streams[1].open);
  }
  EXPECT_FALSE(record_->streams[0].open || record_->streams[1].open);
}

TEST_F(LslOutletTest, WithoutTheLibraryTheSessionGoesOnWithASentence) {
  LslOptions absent = options();
  absent.library = "libnowhere_lsl.so";
  EXPECT_THROW(const LslOutlet outlet(absent, now()), InputError);
  EXPECT_THROW(LslOutlet::check_library(absent.library), InputError);
  EXPECT_NO_THROW(LslOutlet::check_library(kStandIn));
  std::string notice;
  EXPECT_EQ(LslOutlet::open(absent, now(), notice), nullptr);
  EXPECT_THAT(notice, HasSubstr("libnowhere_lsl.so"));
  EXPECT_THAT(notice, HasSubstr("Lab Streaming Layer"));
  EXPECT_THAT(notice, HasSubstr("the session continues without its streams"));
  notice.clear();
  EXPECT_NE(LslOutlet::open(options(), now(), notice), nullptr);
  EXPECT_EQ(notice, "");
}

TEST_F(LslOutletTest, ALibraryThatOpensNoStreamLeavesNothingBehind) {
  record_->refuse_outlets = true;
  std::string notice;
  EXPECT_EQ(LslOutlet::open(options(), now(), notice), nullptr);
  EXPECT_THAT(notice, HasSubstr("opens no stream 'haptrial P07': the stand-in was told to fail"));
  EXPECT_EQ(record_->infos, 0);
}

TEST_F(LslOutletTest, AnotherLibraryIsNotTakenForIt) {
  LslOptions wrong = options();
  wrong.library = "libm.so.6";
  std::string notice;
  EXPECT_EQ(LslOutlet::open(wrong, now(), notice), nullptr);
  EXPECT_THAT(notice, HasSubstr("lsl_create_streaminfo"));
}

}  // namespace
}  // namespace haptrial::stream
