// Bytes that a pseudo-terminal receives, and when.

#include "core/stream/marker_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "core/base/error.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::markers {
namespace {

using record::MarkerOf;
using record::MarkerOutput;
using std::chrono::milliseconds;
using test::PseudoTerminal;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<MarkerMeaning> meanings() {
  return {{MarkerOf::kTrial, 0, "trial", 1},
          {MarkerOf::kInterval, 0, "reference", 11},
          {MarkerOf::kStage, 0, "press", 21},
          {MarkerOf::kStage, 1, "hold", 200},
          {MarkerOf::kResponse, 0, "yes", 101}};
}

constexpr std::chrono::hours kForever{1};

TimedOnset onset(MarkerOf what, int index, std::uint64_t sequence) {
  Onset which{what};
  which.index = static_cast<std::int16_t>(index);
  return {which, 0, sequence, PseudoTerminal::now_ns(), 0, false};
}

TickOnsets tick(std::initializer_list<TimedOnset> onsets) {
  TickOnsets all;
  for (const TimedOnset& each : onsets) {
    all.add(each);
  }
  return all;
}

class MarkerThreadTest : public testing::Test {
 protected:
  MarkerThread& open(double pulse) {
    options_.pulse = pulse;
    line_ = std::make_unique<SerialLine>(terminal_.name(), options_.baud);
    MarkerThread::MarkerOutputs outputs;
    outputs.serial = line_.get();
    thread_ = std::make_unique<MarkerThread>(log_, options_, meanings(), std::move(outputs),
                                             PseudoTerminal::now_ns);
    return *thread_;
  }
  void put(const TimedOnset& onset) { log_.put(tick({onset})); }
  std::vector<int> heard(std::size_t count) const {
    test::wait_until([&] { return terminal_.bytes().size() >= count; });
    return terminal_.bytes();
  }

  PseudoTerminal terminal_;
  OnsetLog log_;
  MarkerOptions options_;
  std::unique_ptr<SerialLine> line_;
  std::unique_ptr<MarkerThread> thread_;
};

TEST_F(MarkerThreadTest, CodesOfOneTickFollowInTheOrderOfSend) {
  MarkerThread& thread = open(0.004);
  log_.put(tick({onset(MarkerOf::kTrial, 0, 5), onset(MarkerOf::kInterval, 0, 5),
                 onset(MarkerOf::kStage, 0, 5)}));
  EXPECT_THAT(heard(6), ElementsAre(21, 0, 11, 0, 1, 0));
  EXPECT_TRUE(thread.wait_until_sent(kForever));
  const auto sent = thread.take_sent();
  ASSERT_EQ(sent.size(), 3u);
  for (const SentOnset& each : sent) {
    EXPECT_EQ(each.way, MarkerOutput::kSerial);
    EXPECT_GE(each.written_ns, each.onset.time_ns);
  }
  // A pulse and a gap lie between two codes.
  EXPECT_GE(sent[1].written_ns - sent[0].written_ns, 8'000'000);
  EXPECT_GE(sent[2].written_ns - sent[1].written_ns, 8'000'000);
  EXPECT_THAT(thread.take_sent(), testing::IsEmpty()) << "each is handed over once";
}

TEST_F(MarkerThreadTest, TicksStayInTheirOrder) {
  open(0.0);
  put(onset(MarkerOf::kStage, 0, 5));
  put(onset(MarkerOf::kTrial, 0, 6));
  put(onset(MarkerOf::kStage, 1, 7));
  put(onset(MarkerOf::kResponse, 0, 8));
  EXPECT_THAT(heard(4), ElementsAre(21, 1, 200, 101)) << "a code of 200 is one byte";
}

TEST_F(MarkerThreadTest, SendsOnlyWhatIsAskedFor) {
  options_.send = {MarkerOf::kResponse};
  MarkerThread& thread = open(0.0);
  log_.put(tick({onset(MarkerOf::kTrial, 0, 5), onset(MarkerOf::kStage, 0, 5)}));
  put(onset(MarkerOf::kResponse, 0, 9));
  ASSERT_TRUE(thread.wait_until_sent(kForever));
  EXPECT_THAT(heard(1), ElementsAre(101));
  EXPECT_EQ(thread.take_sent().size(), 1u);
}

/// Neither end hears the other's clock: a byte cannot be heard before its tick, and what the thread
/// says of its writing cannot be later than what came of it.
TEST_F(MarkerThreadTest, WritesAfterTheTickAndInItsOrder) {
  constexpr int kCount = 400;
  MarkerThread& thread = open(0.0);
  std::vector<TimedOnset> onsets;
  for (int i = 0; i < kCount; ++i) {
    onsets.push_back(onset(MarkerOf::kStage, i % 2, static_cast<std::uint64_t>(i)));
    put(onsets.back());
    std::this_thread::sleep_for(milliseconds(3));
  }
  ASSERT_TRUE(thread.wait_until_sent(kForever));
  const std::vector<int> bytes = heard(kCount);
  ASSERT_EQ(bytes.size(), static_cast<std::size_t>(kCount));
  const auto arrived = terminal_.heard();
  const auto sent = thread.take_sent();
  ASSERT_EQ(sent.size(), static_cast<std::size_t>(kCount));
  std::vector<double> latencies;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(bytes[i], i % 2 == 0 ? 21 : 200);
    EXPECT_EQ(sent[i].onset.sequence, i);
    EXPECT_GE(arrived[i].time_ns, onsets[i].time_ns);
    latencies.push_back(1e-6 * static_cast<double>(sent[i].written_ns - onsets[i].time_ns));
  }
  std::ranges::sort(latencies);
  std::printf("tick to write: median %.3f ms, 99 %% %.3f ms, largest %.3f ms\n",
              latencies[kCount / 2], latencies[kCount * 99 / 100], latencies.back());
  EXPECT_GE(latencies.front(), 0.0);
}

TEST_F(MarkerThreadTest, ALineThatDisappearsIsCountedAndSaid) {
  MarkerThread& thread = open(0.0);
  put(onset(MarkerOf::kStage, 0, 1));
  ASSERT_THAT(heard(1), ElementsAre(21));
  EXPECT_EQ(thread.trouble(), "");
  terminal_.unplug();
  for (std::uint64_t i = 2; i < 7; ++i) {
    put(onset(MarkerOf::kStage, 0, i));
  }
  ASSERT_TRUE(thread.wait_until_sent(kForever));
  EXPECT_EQ(thread.lost(), 5u);
  EXPECT_THAT(thread.trouble(), HasSubstr("serial line " + terminal_.name()));
  EXPECT_THAT(thread.trouble(), HasSubstr("the session goes on"));
  const auto sent = thread.take_sent();
  ASSERT_EQ(sent.size(), 6u);
  EXPECT_GE(sent[0].written_ns, 0);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(sent[i].written_ns, -1);
  }
}

TEST_F(MarkerThreadTest, ALineThatComesBackIsOpenedAgain) {
  const test::TemporaryFolder folder;
  const std::string name = (folder / "line").string();
  std::filesystem::create_symlink(terminal_.name(), name);
  SerialLine line(name, options_.baud);
  options_.pulse = 0.0;
  MarkerThread thread(log_, options_, meanings(), {.serial = &line, .stream = {}, .other = {}},
                      PseudoTerminal::now_ns);
  put(onset(MarkerOf::kStage, 0, 1));
  ASSERT_THAT(heard(1), ElementsAre(21));
  terminal_.unplug();
  put(onset(MarkerOf::kStage, 0, 2));
  ASSERT_TRUE(thread.wait_until_sent(kForever));
  EXPECT_EQ(thread.lost(), 1u);
  const PseudoTerminal again;
  std::filesystem::remove(name);
  std::filesystem::create_symlink(again.name(), name);
  std::this_thread::sleep_for(milliseconds(600));  // it is tried twice a second
  put(onset(MarkerOf::kStage, 1, 3));
  test::wait_until([&] { return !again.bytes().empty(); });
  EXPECT_THAT(again.bytes(), ElementsAre(200));
  EXPECT_EQ(thread.lost(), 1u);
  EXPECT_EQ(line.reopened(), 1);
}

TEST_F(MarkerThreadTest, AZeroThatTheLineDoesNotTakeFollowsWhenItDoes) {
  MarkerThread& thread = open(2.0);  // on a busy machine, too, the line is held before the zero
  put(onset(MarkerOf::kStage, 0, 1));
  ASSERT_THAT(heard(1), ElementsAre(21));
  terminal_.hold();
  std::this_thread::sleep_for(milliseconds(2200));
  EXPECT_THAT(terminal_.bytes(), ElementsAre(21));
  put(onset(MarkerOf::kStage, 1, 2));
  ASSERT_TRUE(thread.wait_until_sent(kForever));
  EXPECT_EQ(thread.lost(), 1u) << "no code waits for a line that is full";
  terminal_.go_on();
  EXPECT_THAT(heard(2), ElementsAre(21, 0));
}

TEST_F(MarkerThreadTest, NoCodeStaysOnTheLineAtTheEnd) {
  open(0.05);
  put(onset(MarkerOf::kStage, 0, 1));
  ASSERT_THAT(heard(1), ElementsAre(21));
  thread_.reset();
  EXPECT_THAT(heard(2), ElementsAre(21, 0));
}

TEST(SerialLineTest, WhatIsNoSerialLineGetsASentence) {
  const auto problem = [](const std::string& device) {
    try {
      SerialLine line(device, 115200);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(problem("/dev/no-such-line"), HasSubstr("No such file"));
  EXPECT_THAT(problem("/dev/null"), HasSubstr("is no serial line"));
  EXPECT_THAT(problem("/dev/null"), HasSubstr("remove markers.serial"));
  EXPECT_THROW(SerialLine("/dev/null", 1234), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::markers
