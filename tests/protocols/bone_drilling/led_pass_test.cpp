// A bone that follows another one over a network that loses, doubles, delays and reorders: to the
// bit, with all that is recorded of it; and what is said where it does not.

#include "protocols/bone_drilling/led_pass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "core/tutoring/reliable_stream.h"
#include "core/tutoring/simulated_channel.h"
#include "tests/protocols/drilling_fixture.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::led_pass_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr tutoring::ChannelConditions kBad{
    .delay = 0.02, .jitter = 0.01, .loss = 0.1, .duplication = 0.05, .reordering = 0.2};

template <class Row>
std::vector<Row> rows_of(realtime::BlockLog<Row>& log) {
  std::vector<Row> all;
  log.flush([&](auto rows) { all.insert(all.end(), rows.begin(), rows.end()); });
  return all;
}

/// One end of two simulated ways.
struct End {
  explicit End(bool leads) : bone(leads) {}
  void tick(tutoring::SimulatedChannel& in, tutoring::SimulatedChannel& out, int now) {
    while (const auto bytes = in.receive(1e-3 * now)) {
      stream.hear(tutoring::decode(*bytes)->stream);
    }
    stream.deliver(bone);
    tutoring::TickMessage message;
    message.sequence = static_cast<std::uint64_t>(now) + 1;
    if (stream.wants(bone, now * kMillisecond, 60 * kMillisecond)) {
      stream.fill(message.stream, now * kMillisecond);
      out.send(tutoring::encode(message), 1e-3 * now);
    }
  }

  SharedBone bone;
  tutoring::ReliableStream stream;
};

/// A drilling that leads and one that is led.
class LedPassTest : public testing::Test {
 protected:
  void begin(const tutoring::ChannelConditions& network, bool real = false,
             bone::BoneModel theirs = test::dumbbell(), bool threads = false) {
    now_ = 0;
    teaches_.emplace(true);
    learns_.emplace(false);
    there_.emplace(network, 1, "there");
    back_.emplace(network, 1, "back");
    own_.emplace(test::dumbbell(), threads);
    led_ = std::make_unique<test::Workshop>(std::move(theirs));
    const bone::CompanionParameters beside;
    if (threads) {
      led_->companions =
          std::make_unique<bone::ThreadedCompanions>(*led_->simulator, beside, false);
    } else {
      led_->companions =
          std::make_unique<bone::SteppedCompanions>(*led_->simulator, beside, 1000.0, false);
    }
    teaches_->bone.take_new_bone(own_->simulator->checksum());
    learns_->bone.take_new_bone(led_->simulator->checksum());
    teaches_->bone.prepare_pass(1);
    learns_->bone.prepare_pass(1);
    own_->pass->share(teaches_->bone);
    own_->pass->begin(0);
    pass_ = std::make_unique<LedPass>(LedPass::Parts{*led_->simulator, *led_->companions,
                                                     led_->parameters, led_->logs, learns_->bone,
                                                     1000.0, 1, real, nullptr});
    pass_->begin(0);
  }

  void tick(const device::DeviceReading& reading, const device::DeviceReading& hand) {
    if (own_->pass->state() == PassState::kRunning) {
      own_->pass->tick(reading, 1e-3);
    }
    teaches_->tick(*back_, *there_, now_);
    learns_->tick(*there_, *back_, now_);
    if (pass_->state() == PassState::kRunning) {
      last_ = pass_->tick(hand, 1e-3);
    }
    ++now_;
    if (real_time_) {
      std::this_thread::sleep_for(std::chrono::microseconds(20));
    }
  }
  void attend() {
    for (End* side : {&*teaches_, &*learns_}) {
      const test::Workshop& shop = side == &*teaches_ ? *own_ : *led_;
      if (const auto told = side->bone.attend(*shop.simulator)) {
        (told->differs ? differences_ : checks_).push_back(told->text);
      }
    }
  }
  /// The whole pass, until both sides have settled.
  void drill(int ticks) {
    std::vector<device::DeviceReading> readings = test::through_the_bridge(ticks);
    readings.back().buttons |= 1U << 5;  // finish
    for (int i = 0; i < 4 * ticks && !(teaches_->bone.settled() && learns_->bone.settled()); ++i) {
      const auto at = std::min(static_cast<std::size_t>(i), readings.size() - 1);
      tick(readings[at], test::at({0.0, 0.02, 0.0}));
      attend();
      keep_rows();
    }
  }
  void keep_rows() {
    for (auto& row : rows_of(own_->logs.removals)) {
      removed_.push_back(row);
    }
    for (auto& row : rows_of(led_->logs.removals)) {
      followed_.push_back(row);
    }
    rows_of(own_->logs.tool);
    rows_of(led_->logs.led);
  }

  std::optional<End> teaches_;
  std::optional<End> learns_;
  std::optional<tutoring::SimulatedChannel> there_;
  std::optional<tutoring::SimulatedChannel> back_;
  std::optional<test::Workshop> own_;
  std::unique_ptr<test::Workshop> led_;
  std::unique_ptr<LedPass> pass_;
  PassOutput last_;
  int now_{0};
  bool real_time_{false};
  std::vector<record::RemovalRow> removed_;
  std::vector<record::RemovalRow> followed_;
  std::vector<std::string> checks_;
  std::vector<std::string> differences_;
};

void expect_the_same(const std::vector<record::RemovalRow>& a,
                     const std::vector<record::RemovalRow>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].voxel, b[i].voxel) << i;
    ASSERT_EQ(a[i].piece, b[i].piece) << i;
    ASSERT_EQ(a[i].label, b[i].label) << i;
    // While a part moves to its own volume there are two contacts in place of one to be summed.
    ASSERT_NEAR(a[i].force, b[i].force, 1e-12) << i;
    ASSERT_EQ(a[i].speed, b[i].speed) << i;
    ASSERT_GE(b[i].sequence, a[i].sequence) << i;
  }
}

TEST_F(LedPassTest, OverABadNetworkBothBonesAreTheSameToTheBit) {
  for (const bool real : {false, true}) {
    SCOPED_TRACE(real ? "parts separated by a thread" : "in the tick");
    removed_.clear();
    followed_.clear();
    checks_.clear();
    real_time_ = real;
    begin(kBad, real);
    drill(6000);
    EXPECT_EQ(pass_->state(), PassState::kCompleted);
    EXPECT_GT(own_->simulator->pieces(), 1) << "the bridge is cut";
    EXPECT_EQ(own_->simulator->pieces(), led_->simulator->pieces());
    EXPECT_EQ(own_->simulator->checksum(), led_->simulator->checksum());
    EXPECT_EQ(own_->simulator->amount_left(), led_->simulator->amount_left());
    EXPECT_EQ(pass_->ticks(), own_->pass->ticks());
    EXPECT_GT(removed_.size(), 20u);
    expect_the_same(removed_, followed_);
    EXPECT_THAT(differences_, IsEmpty());
    ASSERT_EQ(checks_.size(), 2u);
    EXPECT_EQ(checks_[0], checks_[1]);
    EXPECT_THAT(checks_[0], HasSubstr("the same after 6000 ticks"));
    EXPECT_GT(teaches_->stream.again(), 100u) << "a tenth is lost";
    EXPECT_LT(now_, 6500) << "what is lost is soon there";
  }
}

TEST_F(LedPassTest, TheHandThatIsLedFeelsTheBoneAndRemovesNothing) {
  begin({});
  const double before = led_->simulator->amount_left();
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {  // the other side's burr turns in the air
    const double y = 0.006 - 0.008 * std::min(1.0, i / 400.0);
    tick(test::at({0.0, 0.02, 0.0}, 1U), test::at({-0.004, y, 0.0}, 1U));
    most = std::max(most, last_.force.norm());
  }
  EXPECT_GT(most, 0.1);
  EXPECT_EQ(led_->simulator->amount_left(), before);
  EXPECT_TRUE(rows_of(led_->logs.removals).empty());
}

TEST_F(LedPassTest, AnotherBoneIsSaidOnce) {
  bone::BoneModel other = test::dumbbell();
  other.labels[0] = 0;
  begin({}, false, other);
  drill(1000);
  ASSERT_EQ(differences_.size(), 3u) << testing::PrintToString(differences_);
  EXPECT_THAT(differences_[0], HasSubstr("differ from the beginning"));
  for (const int end : {1, 2}) {
    EXPECT_THAT(differences_[static_cast<std::size_t>(end)], HasSubstr("after 1000 ticks"));
  }
  EXPECT_THAT(checks_, IsEmpty());
}

TEST_F(LedPassTest, AVoxelThatChangesOnOneSideIsSaidOnTheTickOnWhichItMatters) {
  begin({});
  const auto readings = test::through_the_bridge(3000);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (i == 500) {  // bone that the burr is about to reach becomes softer
      bone::BoneVolume& volume = led_->simulator->world().volume(0);
      for (int k = 0; k < 12; ++k) {
        const std::int32_t address = volume.address({11, 11, k});
        volume.take(address, 0.25F * volume.density(address));
      }
    }
    tick(readings[i], test::at({0.0, 0.02, 0.0}));
    attend();
    keep_rows();
  }
  ASSERT_EQ(differences_.size(), 1u) << testing::PrintToString(differences_);
  EXPECT_THAT(differences_[0], HasSubstr("differ from tick "));
  const int at = std::stoi(differences_[0].substr(differences_[0].find("tick ") + 5));
  EXPECT_GT(at, 500);
  EXPECT_LT(at, 2500);
}

TEST_F(LedPassTest, ANewBoneThereAsksForANewOneHere) {
  begin({});
  const auto readings = test::through_the_bridge(2000);
  const device::DeviceReading away = test::at({0.0, 0.02, 0.0});
  for (int i = 0; i < 1000; ++i) {
    tick(readings[static_cast<std::size_t>(i)], away);
  }
  // The teacher repeats the trial.
  own_.emplace(test::dumbbell());
  teaches_->bone.take_new_bone(own_->simulator->checksum());
  teaches_->bone.prepare_pass(1);
  own_->pass->share(teaches_->bone);
  own_->pass->begin(0);
  for (int i = 0; i < 1000 && pass_->state() == PassState::kRunning; ++i) {
    tick(readings[static_cast<std::size_t>(i)], away);
  }
  EXPECT_EQ(pass_->state(), PassState::kAborted);
  ASSERT_TRUE(learns_->bone.needs_new_bone());
  pass_.reset();
  led_ = std::make_unique<test::Workshop>();
  learns_->bone.take_new_bone(led_->simulator->checksum());
  learns_->bone.prepare_pass(1);
  led_->companions = std::make_unique<bone::SteppedCompanions>(
      *led_->simulator, bone::CompanionParameters{}, 1000.0, false);
  pass_ = std::make_unique<LedPass>(LedPass::Parts{*led_->simulator, *led_->companions,
                                                   led_->parameters, led_->logs, learns_->bone,
                                                   1000.0, 1, false, nullptr});
  pass_->begin(0);
  drill(2000);
  EXPECT_THAT(differences_, IsEmpty());
  EXPECT_EQ(own_->simulator->checksum(), led_->simulator->checksum());
  EXPECT_EQ(pass_->ticks(), own_->pass->ticks()) << "those before are followed, too";
}

TEST_F(LedPassTest, TicksDoNotAllocateBesideThreads) {
  begin(kBad, true, test::dumbbell(), true);
  const auto readings = test::through_the_bridge(6000);
  const device::DeviceReading hand = test::at({0.0, 0.005, 0.0}, 1U);
  std::size_t count = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    {
      const test::AllocationGuard guard;
      tick(readings[i], hand);
      count += guard.count();
    }
    keep_rows();
    if (i % 10 == 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));  // the threads' turn
    }
  }
  EXPECT_EQ(count, 0u);
  EXPECT_GT(followed_.size(), 20u);
}

}  // namespace
}  // namespace haptrial::protocols::led_pass_test
