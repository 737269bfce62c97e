#include "protocols/psychophysics/sequence/trial_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "core/base/random.h"
#include "core/psychometric/procedure/procedure.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

namespace haptrial::protocols {
namespace {

using testing::ElementsAre;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

SessionIdentity taker(int participant = 0) {
  return {participant, "", 7, derived_seed(7, std::to_string(participant))};
}

std::unique_ptr<TrialsDefinition> definition(const std::string& procedure,
                                             const std::string& more = "") {
  auto d = std::make_unique<TrialsDefinition>();
  read_small(small_trials(procedure, more), *d);
  return d;
}

const char* const kTwoTracks = R"([procedure]
kind = "staircase"
variable = "level"
range = [310.0, 600.0]
steps = [40.0, 20.0]
stop = { reversals = 6, trials = 40 }
[[procedure.tracks]]
name = "a"
start = 500.0
[[procedure.tracks]]
name = "b"
start = 320.0
)";

bool answer_of(const TrialSequence&, int trial) {
  return RandomStream(3, std::to_string(trial)).uniform() < 0.7;
}

TEST(TrialSequenceTest, EachTrackGoesAsItWouldAlone) {
  const auto d = definition(kTwoTracks);
  TrialSequence sequence(*d, taker());
  std::map<std::string, std::unique_ptr<psychometric::Procedure>> alone;
  for (const Track& track : d->tracks) {
    alone[track.name] = track.begin(1, track.name);
  }
  std::set<std::string> seen;
  int changes = 0;
  std::string before;
  while (const auto next = sequence.next()) {
    const std::string& name = sequence.running()[static_cast<std::size_t>(next->track)].name;
    auto& twin = *alone.at(name);
    ASSERT_FALSE(twin.finished());
    ASSERT_EQ(next->asked, twin.next());
    const bool right = answer_of(sequence, next->plan.trial);
    twin.report(right ? 1.0 : 0.0, next->applied);
    sequence.conclude(true, right ? 1.0 : 0.0, right);
    seen.insert(name);
    changes += before != name ? 1 : 0;
    before = name;
  }
  EXPECT_TRUE(alone.at("a")->finished());
  EXPECT_TRUE(alone.at("b")->finished());
  EXPECT_EQ(seen.size(), 2U);
  EXPECT_GT(changes, 4);  // interleaved, not one after the other
}

TEST(TrialSequenceTest, TheSameOutcomesLeadToTheSameTrials) {
  const auto d = definition(kTwoTracks);
  TrialSequence first(*d, taker()), again(*d, taker());
  int trials = 0;
  while (const auto next = first.next()) {
    const auto twin = again.next();
    ASSERT_TRUE(twin);
    EXPECT_EQ(next->asked, twin->asked);
    EXPECT_EQ(next->values.intervals, twin->values.intervals);
    EXPECT_EQ(next->plan.stimulus_seed, twin->plan.stimulus_seed);
    const bool right = answer_of(first, ++trials);
    first.conclude(true, right ? 1.0 : 0.0, right);
    again.conclude(true, right ? 1.0 : 0.0, right);
  }
  EXPECT_FALSE(again.next());
}

TEST(TrialSequenceTest, ALevelThatWasNotPresentedIsAskedForAgain) {
  const auto d = definition(kSmallStaircase);
  TrialSequence sequence(*d, taker());
  const auto first = sequence.next();
  sequence.conclude(false, kNothing, false);
  const auto second = sequence.next();
  EXPECT_EQ(first->asked, second->asked);
  EXPECT_EQ(second->plan.trial, first->plan.trial + 1);
}

TEST(TrialSequenceTest, SessionsWithoutACompletedTrialEnd) {
  const auto d = definition(kSmallStaircase);
  TrialSequence sequence(*d, taker());
  int trials = 0;
  while (sequence.next() && trials < 10000) {
    ++trials;
    sequence.conclude(false, kNothing, false);
  }
  EXPECT_LT(trials, 200);
  ASSERT_EQ(sequence.ended_early().size(), 1u);
  EXPECT_NE(sequence.ended_early()[0].find("ended with trials left"), std::string::npos);
}

const char* const kConstant = R"([procedure]
kind = "constant"
variable = "level"
levels = [280.0, 300.0, 320.0]
repetitions = 8
by = ["side"]
[factors]
side = ["left", "right"]
speed = [1.0, 2.0]
)";

TEST(TrialSequenceTest, ConstantStimuliComeEquallyOftenInEveryCombination) {
  const auto d = definition(kConstant);
  TrialSequence sequence(*d, taker());
  std::map<std::pair<std::string, double>, int> counts;
  std::map<std::string, int> speeds;
  while (const auto next = sequence.next()) {
    std::string side, speed;
    for (const GivenValue& value : next->values.values) {
      side = value.name == "side" ? value.formula : side;
      speed = value.name == "speed" ? value.formula : speed;
    }
    ++counts[{side, next->applied.front()}];
    ++speeds[side + speed];
    sequence.conclude(true, 1.0, true);
  }
  EXPECT_EQ(counts.size(), 6U);
  for (const auto& [what, count] : counts) {
    EXPECT_EQ(count, 8) << what.first << what.second;
  }
  EXPECT_EQ(speeds.size(), 4U);
  for (const auto& [what, count] : speeds) {
    EXPECT_EQ(count, 12) << what;
  }
}

std::string blocks_only(const std::string& more) {
  std::string text = small_trials("", more);
  const std::string comparison = "comparison = { stiffness = \"$level\" }\n";
  return text.replace(text.find(comparison), comparison.size(),
                      "comparison = { stiffness = 310.0 }\n");
}

TEST(TrialSequenceTest, CyclesHoldEachCombinationOnceAndProbesKeepApart) {
  TrialsDefinition d;
  read_small(blocks_only(R"([factors]
angle = [0.0, 1.0, 2.0, 3.0]
[[blocks]]
name = "one"
trials = 80
field = "curl"
probe = { name = "catch", share = 0.125, field = "null" }
)"),
             d);
  for (int participant = 0; participant < 20; ++participant) {
    TrialSequence sequence(d, taker(participant));
    std::vector<std::string> angles;
    int probes = 0, last_probe = -2;
    while (const auto next = sequence.next()) {
      const int at = static_cast<int>(angles.size());
      for (const GivenValue& value : next->values.values) {
        if (value.name == "angle") {
          angles.push_back(value.formula);
        }
      }
      if (!next->values.probe.empty()) {
        EXPECT_EQ(next->values.values.back().formula, "'null'");
        EXPECT_GE(at, 4);
        EXPECT_GT(at - last_probe, 1);
        last_probe = at;
        ++probes;
      }
      sequence.conclude(true, kNothing, false);
    }
    ASSERT_EQ(angles.size(), 80U);
    EXPECT_EQ(probes, 10);
    for (std::size_t cycle = 0; cycle < 20; ++cycle) {
      EXPECT_EQ(std::set(angles.begin() + 4 * cycle, angles.begin() + 4 * (cycle + 1)).size(), 4U);
    }
  }
}

TEST(TrialSequenceTest, PracticeComesFirstWithItsLevelAndEndsWithItsCriterion) {
  const auto d =
      definition(kSmallStaircase, "[practice]\ntrials = 10\nright_in_a_row = 3\nlevel = 550.0\n");
  TrialSequence sequence(*d, taker());
  std::vector<bool> practice;
  for (int i = 0; i < 6; ++i) {
    const auto next = sequence.next();
    practice.push_back(next->plan.practice);
    EXPECT_EQ(next->track, next->plan.practice ? -1 : 0);
    EXPECT_EQ(next->plan.block, next->plan.practice ? -1 : 1);
    sequence.conclude(true, next->track < 0 ? kNothing : 1.0, i != 1);
  }
  EXPECT_THAT(practice, ElementsAre(true, true, true, true, true, false));
}

TEST(TrialSequenceTest, NoCombinationThreeTimesInARow) {
  std::string text = kConstant;
  TrialsDefinition d;
  std::string whole = small_trials(text);
  whole.replace(whole.find("participants = 4"), 16, "participants = 4\nmost_in_a_row = 2");
  read_small(whole, d);
  int broken = 0, trials = 0;
  for (int participant = 0; participant < 10; ++participant) {
    TrialSequence sequence(d, taker(participant));
    std::vector<std::string> sides;
    while (const auto next = sequence.next()) {
      sides.push_back(next->plan.condition);
      const std::size_t n = sides.size();
      ++trials;
      broken += n > 2 && sides[n - 1] == sides[n - 2] && sides[n - 2] == sides[n - 3] ? 1 : 0;
      sequence.conclude(true, 1.0, true);
    }
  }
  // Only at the very end may one combination be all that is left.
  EXPECT_LE(broken, trials / 20);
}

TEST(TrialSequenceTest, IntervalsComeInEitherOrderEquallyOften) {
  const auto d = definition(R"([procedure]
kind = "constant"
variable = "level"
levels = [310.0, 320.0]
repetitions = 500
)");
  TrialSequence sequence(*d, taker());
  int first = 0, trials = 0;
  while (const auto next = sequence.next()) {
    first += next->values.intervals.front() == 0 ? 1 : 0;
    ++trials;
    sequence.conclude(true, 1.0, true);
  }
  EXPECT_EQ(trials, 1000);
  EXPECT_NEAR(first, 500, 4.0 * std::sqrt(250.0));  // binomial
}

TEST(TrialSequenceTest, BlocksAreCounterbalancedOverParticipants) {
  TrialsDefinition d;
  std::string text = blocks_only(
      "[[blocks]]\nname = \"a\"\ntrials = 1\n[[blocks]]\nname = \"b\"\ntrials = 1\n"
      "[[blocks]]\nname = \"c\"\ntrials = 1\n[[blocks]]\nname = \"d\"\ntrials = 1\n");
  text.replace(text.find("participants = 4"), 16, "participants = 4\nblocks = \"williams\"");
  read_small(text, d);
  std::map<std::pair<std::size_t, std::size_t>, int> at;  // block, place
  for (int participant = 0; participant < 4; ++participant) {
    const TrialSequence sequence(d, taker(participant));
    for (std::size_t place = 0; place < 4; ++place) {
      ++at[{sequence.blocks()[place], place}];
    }
  }
  EXPECT_EQ(at.size(), 16U);  // each block once at each place
}

const char* const kFourBlocks =
    "[[blocks]]\nname = \"a\"\ntrials = 1\n[[blocks]]\nname = \"b\"\ntrials = 1\n"
    "[[blocks]]\nname = \"c\"\ntrials = 1\n[[blocks]]\nname = \"d\"\ntrials = 1\n";

/// Four blocks over two days: three on the first, two on the second, one of them for a second time.
std::string two_days(const std::string& order) {
  std::string text = blocks_only(std::string(kFourBlocks) +
                                 "[design.session.1]\nblocks = [\"d\", \"a\", \"b\"]\n" +
                                 "[design.session.2]\nblocks = [\"c\", \"a\"]\n");
  return text.replace(text.find("participants = 4"), 16,
                      "participants = 4\nsessions = 2\nblocks = \"" + order + "\"");
}

std::vector<std::string> names_of(const TrialsDefinition& d, const SessionIdentity& taker) {
  std::vector<std::string> names;
  const TrialSequence sequence(d, taker);
  for (const std::size_t block : sequence.blocks()) {
    names.push_back(d.order.blocks[block].name);
  }
  return names;
}

TEST(TrialSequenceTest, ASessionHasItsBlocksAlone) {
  TrialsDefinition d;
  read_small(two_days("fixed"), d);
  SessionIdentity own = taker();
  EXPECT_THAT(names_of(d, own), ElementsAre("d", "a", "b"));
  own.session = 2;
  EXPECT_THAT(names_of(d, own), ElementsAre("c", "a"));
  EXPECT_EQ(d.most_trials(1), 3);
  EXPECT_EQ(d.most_trials(2), 2);
  EXPECT_EQ(d.most_trials(), 3);
  TrialSequence sequence(d, own);
  std::vector<double> sessions;
  while (const auto next = sequence.next()) {
    sessions.push_back(next->values.session);
    sequence.conclude(true, kNothing, false);
  }
  EXPECT_THAT(sessions, ElementsAre(2.0, 2.0));
}

TEST(TrialSequenceTest, EachSessionIsCounterbalancedByItself) {
  TrialsDefinition d;
  read_small(two_days("latin"), d);
  std::map<std::pair<std::string, std::size_t>, int> first_day, second_day;
  for (int participant = 0; participant < 6; ++participant) {
    SessionIdentity own = taker(participant);
    for (auto* day : {&first_day, &second_day}) {
      own.session = day == &first_day ? 1 : 2;
      const auto names = names_of(d, own);
      for (std::size_t place = 0; place < names.size(); ++place) {
        ++(*day)[{names[place], place}];
      }
    }
  }
  EXPECT_EQ(first_day.size(), 9U);
  EXPECT_EQ(second_day.size(), 4U);
  for (const auto& [where, times] : first_day) {
    EXPECT_EQ(times, 2) << where.first << " at " << where.second;  // 6 participants, 3 places
  }
  for (const auto& [where, times] : second_day) {
    EXPECT_EQ(times, 3) << where.first << " at " << where.second;
  }
}

TEST(TrialSequenceTest, LevelsAreQuantisedWithinTheirRange) {
  Track track;
  track.low = 310.0;
  track.high = 600.0;
  track.resolution = 25.0;
  EXPECT_DOUBLE_EQ(track.applied(333.0), 325.0);
  EXPECT_DOUBLE_EQ(track.applied(0.0), 325.0);  // 300 would be below the range
  EXPECT_DOUBLE_EQ(track.applied(1e4), 600.0);
}

TEST(TrialSequenceTest, WhatIsPostponedComesAtTheEndOfItsBlock) {
  const auto d = definition("",
                            "[factors]\nlevel = [310, 320, 330, 340, 350]\n[[blocks]]\nname = "
                            "\"one\"\ntrials = 5\n[[blocks]]\nname = \"two\"\ntrials = 5\n");
  TrialSequence plain(*d, taker()), sequence(*d, taker());
  std::vector<std::string> planned, presented;
  while (const auto next = plain.next()) {
    planned.push_back(next->plan.condition);
    plain.conclude(true, 1.0, true);
  }
  ASSERT_EQ(planned.size(), 10U);
  while (const auto next = sequence.next()) {
    presented.push_back(next->plan.condition);
    if (presented.size() == 2) {
      sequence.postpone();
    } else {
      sequence.conclude(true, 1.0, true);
    }
  }
  std::vector<std::string> expected = planned;
  expected.insert(expected.begin() + 5, planned[1]);
  EXPECT_EQ(presented, expected);
}

TEST(TrialSequenceTest, AListOfLevelsTakesAPostponedOneLast) {
  const auto d = definition(
      "[procedure]\nkind = \"constant\"\nvariable = \"level\"\nlevels = [310.0, 320.0, "
      "330.0]\nrepetitions = 2\n");
  TrialSequence plain(*d, taker()), sequence(*d, taker());
  std::vector<double> planned, presented;
  while (const auto next = plain.next()) {
    planned.push_back(next->applied.front());
    plain.conclude(true, 1.0, true);
  }
  while (const auto next = sequence.next()) {
    presented.push_back(next->applied.front());
    if (presented.size() == 3) {
      sequence.postpone();
    } else {
      sequence.conclude(true, 1.0, true);
    }
  }
  ASSERT_EQ(planned.size(), 6U);
  planned.push_back(planned[2]);
  EXPECT_EQ(presented, planned);
}

TEST(TrialSequenceTest, AStaircaseAsksForAPostponedLevelAgain) {
  const auto d = definition(kSmallStaircase);
  TrialSequence sequence(*d, taker());
  const double first = sequence.next()->applied.front();
  sequence.postpone();
  EXPECT_EQ(sequence.next()->applied.front(), first);
  EXPECT_EQ(sequence.next()->plan.trial, 2);
  EXPECT_EQ(sequence.running().front().trials, 0);
}

}  // namespace
}  // namespace haptrial::protocols
