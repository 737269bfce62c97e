#include "core/bone/nerve/stimulator.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace haptrial::nerve::stimulator_test {
namespace {

using record::NerveEventRow;
using record::NerveStimulusRow;
using Kind = NerveStimulusRow::Kind;

TEST(ThresholdSearchTest, FindsTheThresholdWithinATwentieth) {
  for (const double threshold : {0.06e-3, 0.1e-3, 0.8e-3, 2.5e-3}) {
    ThresholdSearch search;
    int pulses = 0;
    while (!search.done()) {
      search.tell(search.current() >= threshold);
      ++pulses;
    }
    EXPECT_FALSE(search.out_of_range());
    EXPECT_GE(search.threshold(), threshold);
    EXPECT_LE(search.threshold(), 1.05 * threshold);
    EXPECT_LE(pulses, 10);
  }
  ThresholdSearch deaf;
  deaf.tell(false);
  EXPECT_TRUE(deaf.done() && deaf.out_of_range());
}

/// A probe that gives five pulses a second at 1 kHz, on a nerve that answers from a current on. The
/// answer begins after 6 ms and is known as an event 0.11 s later.
class StimulatorRun {
 public:
  explicit StimulatorRun(double threshold) : threshold_(threshold) {}

  void run(double seconds) {
    for (const std::uint64_t end = now_ + static_cast<std::uint64_t>(1e3 * seconds); now_ < end;
         ++now_) {
      std::vector<NerveEventRow> ended;
      if (answer_ > 0 && now_ == answer_ + 110) {
        NerveEventRow event;
        event.channel = 1;
        event.kind = NerveEventRow::Kind::kResponse;
        event.begin = answer_;
        ended.push_back(event);
      }
      const double pulse = now_ % 200 == 0 ? static_cast<double>(current->load()) : 0.0;
      pulses += pulse > 0.0;
      if (pulse >= threshold_ && now_ >= busy_until) {
        answer_ = now_ + 6;
      }
      stimulator.follow(now_, pulse, now_ >= busy_until, ended, rows);
    }
  }
  std::size_t count(Kind kind) const {
    return static_cast<std::size_t>(std::ranges::count(rows, kind, &NerveStimulusRow::kind));
  }

  PulseCurrent current{std::make_shared<std::atomic<float>>(0.5e-3f)};
  Stimulator stimulator{current, 1000.0};
  std::vector<NerveStimulusRow> rows;
  int pulses{0};
  std::uint64_t busy_until{0};  // tick; until then an event hides every answer

 private:
  double threshold_;
  std::uint64_t now_{1};
  std::uint64_t answer_{0};  // tick of the last one; 0: none
};

TEST(StimulatorTest, ASearchFindsTheCurrentFromPulsesAndAnswers) {
  for (const double threshold : {0.06e-3, 0.2e-3, 0.8e-3, 2.5e-3}) {
    StimulatorRun bench(threshold);
    bench.run(0.3);
    bench.stimulator.search(1);
    bench.run(3.0);
    ASSERT_TRUE(bench.stimulator.found());
    EXPECT_FALSE(bench.stimulator.searching());
    EXPECT_FALSE(bench.stimulator.found()->out_of_range);
    EXPECT_GE(bench.stimulator.found()->current, 0.999 * threshold);
    EXPECT_LE(bench.stimulator.found()->current, 1.051 * threshold);
    EXPECT_EQ(bench.stimulator.found()->channel, 1u);
    EXPECT_NEAR(bench.stimulator.current(), bench.stimulator.found()->current, 1e-9);
    EXPECT_EQ(bench.count(Kind::kPulse), static_cast<std::size_t>(bench.pulses));
    EXPECT_EQ(bench.count(Kind::kSet), 1u);
    EXPECT_EQ(bench.count(Kind::kSearch), 1u);
    EXPECT_EQ(bench.count(Kind::kFound), 1u);
  }
}

TEST(StimulatorTest, ASearchWaitsUntilAnEventOfTheChannelIsOver) {
  StimulatorRun bench(0.2e-3);
  bench.busy_until = 1500;
  bench.stimulator.search(1);
  bench.run(1.4);
  EXPECT_TRUE(bench.stimulator.searching()) << "seven pulses, and nothing is known";
  bench.run(3.0);
  ASSERT_TRUE(bench.stimulator.found());
  EXPECT_FALSE(bench.stimulator.found()->out_of_range);
  EXPECT_LE(bench.stimulator.found()->current, 1.051 * 0.2e-3);
}

TEST(StimulatorTest, ANerveOutOfReachIsSaidToBe) {
  StimulatorRun deaf(1.0);
  deaf.stimulator.search(1);
  deaf.run(1.0);
  ASSERT_TRUE(deaf.stimulator.found());
  EXPECT_TRUE(deaf.stimulator.found()->out_of_range);
  EXPECT_NEAR(deaf.stimulator.found()->current, kMostStimulus, 1e-9);
  StimulatorRun bare(0.01e-3);
  bare.stimulator.search(1);
  bare.run(1.5);
  ASSERT_TRUE(bare.stimulator.found());
  EXPECT_TRUE(bare.stimulator.found()->out_of_range);
  EXPECT_NEAR(bare.stimulator.found()->current, kLeastStimulus, 1e-9);
  EXPECT_EQ(bare.count(Kind::kOutOfRange), 1u);
}

TEST(StimulatorTest, AnAnswerOfAnotherChannelIsNone) {
  StimulatorRun bench(0.2e-3);
  bench.stimulator.search(0);
  bench.run(1.0);
  ASSERT_TRUE(bench.stimulator.found());
  EXPECT_TRUE(bench.stimulator.found()->out_of_range);
}

TEST(StimulatorTest, ACurrentThatIsSetEndsASearchAndStaysWithinWhatAProbeGives) {
  StimulatorRun bench(0.2e-3);
  bench.stimulator.search(1);
  bench.run(0.5);
  bench.stimulator.set(1.0);
  EXPECT_FALSE(bench.stimulator.searching());
  EXPECT_NEAR(bench.stimulator.current(), kMostStimulus, 1e-9);
  bench.run(1.0);
  EXPECT_FALSE(bench.stimulator.found());
  EXPECT_EQ(bench.rows.back().channel, -1);
}

}  // namespace
}  // namespace haptrial::nerve::stimulator_test
