#include "protocols/psychophysics/sequence/trial_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "core/base/random.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/record/table/schema.h"
#include "protocols/psychophysics/definition/every_value.h"
#include "protocols/psychophysics/definition/trial_values.h"
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

TEST(TrialSequenceTest, LongLevelsAreEachCutToTheRoomOfACondition) {
  TrialsDefinition d;
  read_small(blocks_only(R"([factors]
material = ["soft silicone with a rough coating", "hard acrylic"]
tool = ["long steel needle with a bevelled tip", "short needle"]
[[blocks]]
name = "one"
trials = 4
field = "curl"
)"),
             d);
  TrialSequence sequence(d, taker());
  std::set<std::string> conditions;
  while (const auto next = sequence.next()) {
    EXPECT_LE(next->plan.condition.size(), record::kConditionBytes);
    conditions.insert(next->plan.condition);
    sequence.conclude(true, 1.0, true);
  }
  EXPECT_THAT(conditions,
              ElementsAre("hard acrylic, long steel needle with a bevelled tip",
                          "hard acrylic, short needle",
                          "soft silicone with a rough coat, long steel needle with a bevell",
                          "soft silicone with a rough coating, short needle"));
}

TEST(TrialSequenceTest, AConditionIsShownInTheOrderOfTheFactorsAsWritten) {
  TrialsDefinition d;
  read_small(blocks_only(R"([factors]
standard = ["low", "high"]
comparison = ["low", "high"]
[[blocks]]
name = "one"
trials = 4
field = "curl"
)"),
             d);
  const std::map<std::string, std::string> shown = d.shown_conditions();
  TrialSequence sequence(d, taker());
  std::set<std::string> conditions;
  while (const auto next = sequence.next()) {
    std::map<std::string, std::string> levels;
    for (const GivenValue& value : next->values.values) {
      levels[value.name] = shown_level(value.formula);
    }
    EXPECT_EQ(next->plan.condition, levels.at("comparison") + ", " + levels.at("standard"));
    EXPECT_EQ(shown.at(next->plan.condition),
              levels.at("standard") + ", " + levels.at("comparison"));
    conditions.insert(next->plan.condition);
    sequence.conclude(true, 1.0, true);
  }
  EXPECT_EQ(conditions.size(), 4U);
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

TEST(TrialSequenceTest, ProbesBesideAProcedureAreCountedAsTheyComeOnAverage) {
  const auto plain = definition(kSmallStaircase, "[[blocks]]\nname = \"main\"\n");
  const auto probed = definition(kSmallStaircase,
                                 "[[blocks]]\nname = \"main\"\nfield = \"curl\"\n"
                                 "probe = { name = \"catch\", share = 0.2, field = \"null\" }\n");
  const int trials = plain->most_trials();
  EXPECT_EQ(probed->most_trials(), trials + (trials + 3) / 4);
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

/// Titrates with a staircase for each side, then tests multiples of what it found.
const char* const kTitrated = R"([variables]
level = 400.0
times = 1.0
[factors]
side = ["left", "right"]
[[procedures]]
name = "titration"
kind = "staircase"
variable = "level"
by = ["side"]
range = [310.0, 600.0]
start = 500.0
steps = [40.0, 20.0]
stop = { reversals = 6, trials = 40 }
[[procedures]]
name = "test"
kind = "constant"
variable = "times"
by = ["side"]
levels = [0.5, 1.0, 1.5]
repetitions = 2
[[blocks]]
name = "find"
procedures = ["titration"]
hardness = "$level"
[[blocks]]
name = "use"
procedures = ["test"]
)";

/// A definition whose second block presents multiples of what the first one found.
std::string titrated(const std::string& used = "$times * $titration.threshold") {
  std::string whole = small_trials(kTitrated + ("hardness = \"" + used + "\"\n"));
  whole.replace(whole.find("\"$level\""), 8, "\"$hardness\"");
  return whole;
}

/// Every threshold of a session with right answers from a level on, which may depend on the side.
std::vector<double> thresholds_used(const TrialsDefinition& d, double left, double right,
                                    std::vector<std::string>* ended = nullptr) {
  TrialSequence sequence(d, taker());
  std::map<std::string, std::unique_ptr<psychometric::Procedure>> alone;
  std::vector<double> used;
  while (const auto next = sequence.next()) {
    const RunningTrack& track = sequence.running()[static_cast<std::size_t>(next->track)];
    double answer = 1.0;
    if (track.track->name == "titration") {
      answer = next->applied[0] > (next->plan.condition == "left" ? left : right) ? 1.0 : 0.0;
      auto& twin = alone[next->plan.condition];
      twin = twin ? std::move(twin) : track.track->begin(1, "");
      twin->report(answer, next->applied);
    } else {
      const double threshold = next->values.thresholds.back().second;
      EXPECT_EQ(threshold, alone.at(next->plan.condition)->estimates().at(0).value);
      used.push_back(threshold);
    }
    sequence.conclude(true, answer, answer == 1.0);
  }
  if (ended != nullptr) {
    *ended = sequence.ended_early();
  }
  return used;
}

TEST(TrialSequenceTest, ABlockUsesTheThresholdThatAnEarlierOneFound) {
  TrialsDefinition d;
  read_small(titrated(), d);
  check_every_value(d);
  EXPECT_THAT(d.order.blocks[0].needs, testing::IsEmpty());
  EXPECT_THAT(d.order.blocks[1].needs, ElementsAre("titration"));
  const std::vector<double> used = thresholds_used(d, 350.0, 450.0);
  ASSERT_EQ(used.size(), 12U);  // 3 levels twice, for each side
  EXPECT_NEAR(*std::ranges::min_element(used), 350.0, 20.0);
  EXPECT_NEAR(*std::ranges::max_element(used), 450.0, 20.0);
}

TEST(TrialSequenceTest, ABlockWhoseThresholdWasNotFoundIsLeftOutAndSaid) {
  TrialsDefinition d;
  read_small(titrated(), d);
  check_every_value(d);
  std::vector<std::string> ended;
  // Always right: the level ends at the bottom of the range without a reversal.
  EXPECT_THAT(thresholds_used(d, 0.0, 450.0, &ended), testing::IsEmpty());
  EXPECT_THAT(ended,
              ElementsAre("block use was left out, since titration, left found no threshold"));
}

TEST(TrialSequenceTest, AStatedValueStandsInForAThresholdThatWasNotFound) {
  std::string text = titrated();
  text.replace(text.find("[variables]"), 11, "[variables]\n\"titration.threshold\" = 350.0");
  TrialsDefinition d;
  read_small(text, d);
  check_every_value(d);
  EXPECT_THAT(d.order.blocks[1].needs, testing::IsEmpty());
}

TEST(TrialSequenceTest, AThresholdIsFoundBeforeItIsUsed) {
  std::string text = titrated();
  text.replace(text.find("[[blocks]]"), 10,
               "[[blocks]]\nname = \"use first\"\nprocedures = [\"test\"]\n"
               "hardness = \"$titration.threshold\"\n[[blocks]]");
  EXPECT_THAT(problems_of_trials(text),
              testing::Contains(testing::HasSubstr(
                  "block use first uses $titration.threshold, but in the session no block before "
                  "it asks that procedure; put one before it, or state")));
  EXPECT_THAT(problems_of_trials(titrated("$test.threshold")),
              testing::Contains(testing::HasSubstr("there is no variable test.threshold")));
}

TEST(TrialSequenceTest, TwoProceduresSetOneVariableInDifferentBlocks) {
  std::string text = titrated("$level");
  const auto times = text.find("variable = \"times\"");
  text.replace(times, 18, "variable = \"level\"");
  text.replace(text.find("levels = [0.5, 1.0, 1.5]"), 24, "levels = [320.0, 400.0, 480.0]");
  EXPECT_THAT(problems_of_trials(text), testing::IsEmpty());
  text.replace(text.find("procedures = [\"test\"]"), 21, "procedures = [\"test\", \"titration\"]");
  EXPECT_THAT(problems_of_trials(text),
              testing::Contains(testing::HasSubstr(
                  "procedures set level twice in the block use, by titration and by test; name the "
                  "procedures of each block")));
}

/// Trials of one block without procedures, with two factors. @param design  more of [design]
std::string two_factors(const std::string& design) {
  std::string whole = small_trials(
      "[variables]\nlevel = 400.0\n[factors]\nside = [\"left\", \"right\"]\nsize = [1, 2, 3]\n"
      "[[blocks]]\nname = \"a\"\ntrials = 600\n");
  whole.replace(whole.find("participants = 4"), 16, "participants = 4\n" + design);
  return whole;
}

std::vector<TrialValues> trials_of(const std::string& text, int participant = 0) {
  TrialsDefinition d;
  read_small(text, d);
  TrialSequence sequence(d, taker(participant));
  std::vector<TrialValues> all;
  while (const auto next = sequence.next()) {
    all.push_back(next->values);
    sequence.conclude(true, kNothing, true);
  }
  return all;
}

std::string label_of(const TrialValues& trial) {
  return trial.values[0].formula + trial.values[1].formula;
}

TEST(TrialSequenceTest, ALevelOfAFactorMayBeLimitedByItself) {
  int side_run = 0, size_run = 0, longest_size = 0;
  std::string side, size;
  for (const TrialValues& trial : trials_of(two_factors("most_in_a_row = { side = 2 }"))) {
    side_run = trial.values[0].formula == side ? side_run + 1 : 1;
    size_run = trial.values[1].formula == size ? size_run + 1 : 1;
    side = trial.values[0].formula;
    size = trial.values[1].formula;
    EXPECT_LE(side_run, 2);
    longest_size = std::max(longest_size, size_run);
  }
  EXPECT_GT(longest_size, 2);  // free
}

/// How often a trial repeats the combination of the one before.
double repeats(const std::vector<TrialValues>& trials) {
  double count = 0.0;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    count += label_of(trials[i]) == label_of(trials[i - 1]) ? 1.0 : 0.0;
  }
  return count;
}

TEST(TrialSequenceTest, TrialsComeInCyclesShuffledOrAtRandom) {
  const auto cycles = trials_of(two_factors("trials = \"cycles\""));
  for (std::size_t begin = 0; begin < cycles.size(); begin += 6) {
    std::set<std::string> seen;
    for (std::size_t i = begin; i < begin + 6; ++i) {
      seen.insert(label_of(cycles[i]));
    }
    EXPECT_EQ(seen.size(), 6U);
  }
  std::map<std::string, int> shuffled, random;
  const auto shuffled_trials = trials_of(two_factors("trials = \"shuffled\""));
  const auto random_trials = trials_of(two_factors("trials = \"random\""));
  for (std::size_t i = 0; i < 600; ++i) {
    ++shuffled[label_of(shuffled_trials[i])];
    ++random[label_of(random_trials[i])];
  }
  double chi = 0.0;
  for (const auto& [label, count] : shuffled) {
    EXPECT_EQ(count, 100) << label;
  }
  for (const auto& [label, count] : random) {
    chi += (count - 100.0) * (count - 100.0) / 100.0;
  }
  EXPECT_GT(chi, 0.0);
  EXPECT_LT(chi, 20.5);  // chi-squared with 5 degrees of freedom, p = 0.001
  const double deviation = std::sqrt(599.0 * 5.0 / 36.0);  // binomial
  EXPECT_NEAR(repeats(shuffled_trials), 600.0 * 99.0 / 599.0, 4.0 * deviation);
  EXPECT_NEAR(repeats(random_trials), 599.0 / 6.0, 4.0 * deviation);
  EXPECT_THAT(problems_of_trials(two_factors("trials = \"random\"\nmost_in_a_row = 2")),
              testing::Contains(testing::HasSubstr("draws each trial without one")));
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
