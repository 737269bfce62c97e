#include "analysis/quality/trial_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/force_training/report/report.h"
#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/score/score_parameters.h"
#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/quality_summary.h"
#include "analysis/force_training/study/study.h"
#include "tests/analysis/force_training/synthetic_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TrialQuality good() {
  TrialQuality q;
  for (RunQuality* run : {&q.test, &q.training}) {
    *run = {12.0, 9.0, 8.0, 0.02, 0.001, 45.0, 0.0, 0.0, 0.05, 0.0, 0.0};
  }
  q.lag = 0.05;
  q.path_duration = 12.0;
  return q;
}

TEST(TrialQualityTest, NothingKnownAndAllInOrderAreNotFlagged) {
  EXPECT_EQ(flag_names({}), "");
  EXPECT_EQ(flag_names(good()), "");
}

TEST(TrialQualityTest, EachNumberBeyondItsThresholdIsAFlagWithTheNumber) {
  struct Case {
    const char* name;
    const char* reason;
    void (*spoil)(TrialQuality&);
  };
  const Case cases[] = {
      {"saturated", "97.0 % of the run at the force limit (flagged above 15 %)",
       [](TrialQuality& q) { q.test.saturation = 0.97; }},
      {"training_saturated", "training: 40.0 % of the run at the force limit (flagged above 15 %)",
       [](TrialQuality& q) { q.training.saturation = 0.4; }},
      {"oscillating", "the force swung at 45 Hz for 6.0 % of the run (flagged above 5 %)",
       [](TrialQuality& q) { q.test.oscillation = 0.06; }},
      {"lag", "the hand was 200 ms behind the target (flagged above 150 ms)",
       [](TrialQuality& q) { q.lag = 0.2; }},
      {"lag", "the hand was 160 ms ahead of the target (flagged above 150 ms)",
       [](TrialQuality& q) { q.lag = -0.16; }},
      {"duration", "the run took 9.00 s, the path at its own speed 12.00 s (flagged beyond 2 %)",
       [](TrialQuality& q) { q.test.duration = 9.0; }},
      {"duration",
       "the run took 40.00 s, the path at its own speed 12.00 s (flagged beyond a factor of 3)",
       [](TrialQuality& q) { q.own_pace = true, q.test.duration = 40.0; }},
      {"missing_ticks", "50.0 % of the run's ticks missing (flagged above 1 %)",
       [](TrialQuality& q) { q.test.missing_ticks = 0.5; }},
      {"late_ticks", "3.0 % of the run's ticks late (flagged above 1 %)",
       [](TrialQuality& q) { q.test.late_ticks = 0.03; }},
      {"jump", "the position jumped: 3.00 m/s between two ticks (flagged above 1 m/s)",
       [](TrialQuality& q) { q.test.top_speed = 3.0; }},
      {"training_reduced_damping",
       "training: 30.0 % of the run with reduced damping (flagged above 10 %)",
       [](TrialQuality& q) { q.training.reduced_damping = 0.3; }},
      {"training_dropped_frames",
       "training: 5.0 % of the screen's refreshes without a new picture (flagged above 2 %)",
       [](TrialQuality& q) { q.training.dropped_frames = 0.05; }},
      {"no_force", "the applied force reached 0.50 N, the target 9.00 N (flagged below 10 % of it)",
       [](TrialQuality& q) { q.test.peak_force = 0.5; }},
      {"repeated", "attempt 2: the trial was aborted before",
       [](TrialQuality& q) { q.attempt = 2; }}};
  for (const Case& c : cases) {
    TrialQuality q = good();
    c.spoil(q);
    const auto flags = flags_of(q);
    ASSERT_THAT(flags, SizeIs(1)) << c.name;
    EXPECT_EQ(flags[0].name, c.name);
    EXPECT_THAT(flags[0].reason, HasSubstr(c.reason));
  }
}

TEST(TrialQualityTest, AtOnesOwnPaceARunMayTakeTwiceAsLong) {
  TrialQuality q = good();
  q.test.duration = 24.0;
  EXPECT_EQ(flag_names(q), "duration");
  q.own_pace = true;
  EXPECT_EQ(flag_names(q), "");
}

TEST(TrialQualityTest, SeveralFlagsAreJoined) {
  TrialQuality q = good();
  q.test.saturation = 0.97;
  q.test.oscillation = 0.99;
  q.training.saturation = 0.97;
  EXPECT_EQ(flag_names(q), "oscillating;saturated;training_saturated");
}

SyntheticSession session_of(const std::string& subject) {
  SyntheticSession s;
  s.subject = subject;
  s.target = [](double t) { return 5.0 + 3.0 * std::sin(1.9 * t); };
  s.applied = [](const std::string&, int, double, double target) { return target; };
  s.force_limit = 12.0;
  return s;
}

class RecordedQuality : public testing::Test {
 protected:
  StudyResult analyze(const std::vector<SyntheticSession>& sessions) {
    std::vector<std::filesystem::path> files;
    for (const SyntheticSession& session : sessions) {
      files.push_back(folder_ / (session.subject + ".h5"));
      write_session(files.back(), session);
    }
    return analyze_study(files, {}, 1);
  }

  test::TemporaryFolder folder_;
};

TEST_F(RecordedQuality, ARunThatOscillatesAtItsLimitIsToldEverywhere) {
  SyntheticSession bad = session_of("P01");
  bad.rate = 1000.0;
  bad.applied = [](const std::string&, int trial, double t, double target) {
    return trial == 5 ? 250.0 * std::sin(2.0 * std::numbers::pi * 36.0 * t) : target;
  };
  const StudyResult study = analyze({bad});
  ASSERT_EQ(study.scores.size(), 9u) << "a flag excludes nothing";
  for (const TrialScore& score : study.scores) {
    EXPECT_EQ(
        flag_names(score.quality),
        score.trial == 5 ? "oscillating;saturated;training_oscillating;training_saturated" : "");
  }
  const TrialQuality& q = study.scores[4].quality;
  EXPECT_NEAR(*q.test.saturation, 0.97, 0.01);
  EXPECT_NEAR(*q.test.oscillation_frequency, 36.0, 0.3);
  EXPECT_THAT(study.alarms, ElementsAre(AllOf(HasSubstr("1 of 9 scored trials is flagged"),
                                              HasSubstr("oscillating 1"))));
  const std::string report = to_markdown(study_report(study, {}));
  EXPECT_LT(report.find("is flagged for how it was recorded"), report.find("## "));
  EXPECT_THAT(report, HasSubstr("| P01 | 5 | visual | the force swung at 36 Hz for"));
  const auto json = nlohmann::json::parse(statistics_json(study));
  EXPECT_EQ(json["quality"]["participants"][0]["flagged"], 1);
  EXPECT_EQ(json["quality"]["flagged"][0]["trial"], 5);
}

TEST_F(RecordedQuality, LagDurationAndSpeedOfATrialAreThoseOfItsTest) {
  SyntheticSession late = session_of("P01");
  late.lag = 0.2;
  const StudyResult study = analyze({late});
  for (const TrialScore& score : study.scores) {
    EXPECT_NEAR(*score.quality.lag, 0.2, 0.005);
    EXPECT_NEAR(*score.quality.test.duration, 5.0, 0.01);
    EXPECT_NEAR(*score.quality.path_duration, 5.0, 0.02);
    EXPECT_EQ(flag_names(score.quality), "lag");
  }
}

TEST_F(RecordedQuality, EventsAndFramesAreThoseOfTheirPass) {
  SyntheticSession session = session_of("P01");
  session.reduced_trial = 2;
  session.frozen_trial = 3;
  session.second_attempt = 4;
  const StudyResult study = analyze({session});
  std::vector<std::string> flags;
  for (const TrialScore& score : study.scores) {
    flags.push_back(flag_names(score.quality));
  }
  EXPECT_THAT(flags, ElementsAre("", "training_reduced_damping", "training_dropped_frames",
                                 "repeated", "", "", "", "", ""));
  EXPECT_NEAR(*study.scores[1].quality.training.reduced_damping, 0.2, 0.01);
  EXPECT_NEAR(*study.scores[2].quality.training.dropped_frames, 0.5, 0.01);
  EXPECT_FALSE(study.scores[2].quality.test.dropped_frames);
}

TEST_F(RecordedQuality, AParticipantWithFarFewerTrialsIsNamed) {
  SyntheticSession few = session_of("P03");
  few.repetitions = 2;
  const StudyResult study = analyze({session_of("P01"), session_of("P02"), few});
  EXPECT_THAT(study.alarms, ElementsAre(HasSubstr("P03 has 6 scored trials; the median")));
}

TEST_F(RecordedQuality, WhereAllIsInOrderNobodyIsAlarmed) {
  EXPECT_THAT(analyze({session_of("P01"), session_of("P02")}).alarms, IsEmpty());
}

TEST(TrialQualityTest, ATrialWithoutTrainingHasNoneOfItsNumbers) {
  TrialScore score;
  score.quality = good();
  score.quality.training = {};
  EXPECT_THAT(flags_of(score.quality), IsEmpty());
  EXPECT_THAT(scores_csv(std::vector{score}), HasSubstr(",8,0.02,,0.001,45,,"));
}

}  // namespace
}  // namespace haptrial::analysis
