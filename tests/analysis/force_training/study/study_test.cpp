// Analysis from session files to a study, end to end, and who counts as the same
// subject.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/identity_json_internal.h"
#include "analysis/force_training/study/study.h"
#include "analysis/force_training/study/study_result.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/analysis/force_training/synthetic_session.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

double pattern(double t) { return 5.0 + 3.0 * std::sin(1.9 * t) + 1.5 * std::sin(3.1 * t + 1.0); }

class Study : public testing::Test {
 protected:
  Study() : folder_(fs::path(testing::TempDir()) / ("study-" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Study() override { fs::remove_all(folder_); }

  fs::path add(const SyntheticSession& session) {
    const fs::path file = folder_ / (session.subject + ".h5");
    write_session(file, session);
    files_.push_back(file);
    return file;
  }

  SyntheticSession perfect() const {
    SyntheticSession s;
    s.target = pattern;
    s.applied = [](const std::string&, int, double, double target) { return target; };
    return s;
  }

  // Slow wander of the force, larger for conditions that teach less and other for each trial.
  SyntheticSession noisy(const std::string& subject) const {
    SyntheticSession s = perfect();
    s.subject = subject;
    s.applied = [subject](const std::string& condition, int trial, double t, double target) {
      RandomStream random(7, subject + std::to_string(trial));
      const double size = condition == "haptic" ? 2.0 : condition == "visual" ? 1.0 : 0.3;
      const double phase = random.uniform(0.0, 6.0);
      return target + size * random.uniform(0.8, 1.2) * std::sin(4.0 * t + phase);
    };
    return s;
  }

  fs::path folder_;
  std::vector<fs::path> files_;
};

TEST_F(Study, PerfectRecallScoresZero) {
  add(perfect());
  ScoreParameters parameters;
  parameters.filter_width = 0.0;  // the filter alone would change a curve
  const auto study = analyze_study(files_, parameters, 1);
  ASSERT_EQ(study.scores.size(), 9u);
  for (const auto& s : study.scores) {
    EXPECT_EQ(s.score, 0.0);
    EXPECT_EQ(s.rms_unaligned, 0.0);
  }
  EXPECT_THAT(study.statistics.anova.because(), HasSubstr("not vary"));
}

TEST_F(Study, AConstantErrorIsMeasured) {
  auto session = perfect();
  session.target = [](double) { return 4.0; };
  session.applied = [](const std::string&, int, double, double) { return 3.0; };
  add(session);
  const auto study = analyze_study(files_, {}, 1);
  for (const auto& s : study.scores) {
    EXPECT_NEAR(s.rms_force, 1.0, 1e-9);  // both on the grid of the file
    EXPECT_NEAR(s.rms_unaligned, 1.0, 1e-9);
    EXPECT_NEAR(s.rms_slope, 0.0, 1e-9);
  }
}

TEST_F(Study, ScoresAreThoseOfTheCurvesOfEachTrial) {
  auto session = perfect();
  session.repeated_trial = 2;  // its first test has twice the force and must not count
  session.applied = [](const std::string&, int trial, double, double target) {
    return target + 0.125 * trial;
  };
  add(session);
  const auto study = analyze_study(files_, {}, 1);
  ASSERT_EQ(study.scores.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto& s = study.scores[i];
    EXPECT_EQ(s.trial, static_cast<int>(i + 1));
    EXPECT_EQ(s.block, static_cast<int>(i / 3 + 1));
    EXPECT_EQ(s.repetition, static_cast<int>(i % 3 + 1));
    EXPECT_EQ(s.subject, "P01");
    // The filter moves the curve by a few hundredths of a newton, the trial by an eighth.
    EXPECT_NEAR(s.rms_unaligned, 0.125 * s.trial, 0.03);
  }
  EXPECT_EQ(study.scores[3].condition, "visual");
  ASSERT_EQ(study.exclusions.size(), 1u);
  EXPECT_THAT(study.exclusions[0].reason, HasSubstr("repeated"));
}

TEST_F(Study, BlocksOfALaterSessionFollowThoseOfTheFirst) {
  SyntheticSession day = perfect();
  // 0.5 N off in the first block of the first day, 3 N in the last of the second
  day.applied = [](const std::string&, int trial, double, double target) {
    return target + 0.5 * ((trial - 1) / 3 + 1);
  };
  add(day);
  day.session = 2;
  day.applied = [](const std::string&, int trial, double, double target) {
    return target + 0.5 * ((trial - 1) / 3 + 4);
  };
  write_session(folder_ / "P01-session-2.h5", day);
  files_.push_back(folder_ / "P01-session-2.h5");
  const auto study = analyze_study(files_, {}, 1);
  ASSERT_EQ(study.scores.size(), 18u);
  for (const TrialScore& score : study.scores) {
    EXPECT_NEAR(score.rms_unaligned, 0.5 * score.block, 0.03);
  }
  ASSERT_EQ(study.statistics.blocks.size(), 6u);
  EXPECT_EQ(study.statistics.blocks.back().block, 6);
}

TEST_F(Study, TellsGoodConditionsFromBad) {
  for (const char* subject : {"P03", "P01", "P02", "P04"}) {
    add(noisy(subject));
  }
  const auto study = analyze_study(files_, {}, 2);
  EXPECT_THAT(study.statistics.subjects, ElementsAre("P01", "P02", "P03", "P04"));
  const auto& means = study.statistics.summaries;
  EXPECT_GT(*means[0].mean, *means[1].mean);
  EXPECT_GT(*means[1].mean, *means[2].mean);
  EXPECT_LT(study.statistics.repeated->p_corrected, 0.01);
  for (const auto& row : study.statistics.table_1) {
    EXPECT_EQ(row.best, "visuohaptic");
    EXPECT_EQ(row.worst, "haptic");
  }
  ASSERT_EQ(study.recalls.size(), 3u);
  EXPECT_LE(study.recalls[0].score.score, study.recalls[1].score.score);
  EXPECT_LE(study.recalls[1].score.score, study.recalls[2].score.score);
  EXPECT_EQ(study.recalls[2].score.condition, "haptic");
  EXPECT_EQ(study.recalls[0].target.size(), study.recalls[0].warped.size());
}

TEST_F(Study, DoesNotDependOnThreadsNorOnTheOrderOfFiles) {
  for (const char* subject : {"P01", "P02", "P03"}) {
    add(noisy(subject));
  }
  const auto one = analyze_study(files_, {}, 1);
  std::reverse(files_.begin(), files_.end());
  for (const int jobs : {2, 7}) {
    const auto many = analyze_study(files_, {}, jobs);
    EXPECT_EQ(scores_csv(one.scores), scores_csv(many.scores));
    EXPECT_EQ(statistics_json(one), statistics_json(many));
  }
}

TEST_F(Study, RecoversAKnownLagAndError) {
  auto session = perfect();
  session.lag = 0.037;
  session.rate = 1000.0;
  add(session);
  session.subject = "P02";
  session.lag = 0.0;
  session.offset = {0.002, 0.006, 0.003};
  add(session);
  const auto study = analyze_study(files_, {}, 1);
  const auto& late = study.sessions[0].tracking;
  EXPECT_EQ(late.passes, 18u);  // training and test
  EXPECT_NEAR(*late.lag, 0.037, 0.001);
  const auto& aside = study.sessions[1].tracking;
  EXPECT_NEAR(*aside.lag, 0.0, 0.001);
  EXPECT_NEAR(*aside.rms_error, 0.007, 1e-5);
  EXPECT_NEAR(*aside.rms_error_in_plane, std::sqrt(13.0) * 1e-3, 1e-5);
  EXPECT_NEAR(*study.tracking.lag, 0.0185, 0.001);
}

TEST_F(Study, SaysWhichTrialsHaveNoScoreAndWhy) {
  auto session = perfect();
  session.aborted_trial = 4;
  session.untested_trial = 2;
  session.untrained_trial = 9;
  session.applied = [](const std::string&, int trial, double, double target) {
    return trial == 8 ? std::nan("") : target;
  };
  add(session);
  const auto study = analyze_study(files_, {}, 1);
  EXPECT_EQ(study.scores.size(), 5u);
  EXPECT_EQ(study.sessions[0].test_passes, 8u);
  EXPECT_EQ(study.sessions[0].scored, 5u);
  ASSERT_EQ(study.exclusions.size(), 4u);
  EXPECT_EQ(study.exclusions[0].trial, 2);
  EXPECT_THAT(study.exclusions[0].reason, HasSubstr("no test pass"));
  EXPECT_EQ(study.exclusions[1].trial, 4);
  EXPECT_THAT(study.exclusions[1].reason, HasSubstr("aborted"));
  EXPECT_EQ(study.exclusions[2].trial, 8);
  EXPECT_THAT(study.exclusions[2].reason, HasSubstr("not a finite number"));
  EXPECT_EQ(study.exclusions[3].trial, 9);
  EXPECT_THAT(study.exclusions[3].reason, HasSubstr("its training pass was aborted"));
}

TEST_F(Study, ALostTickCostsItsTrialAndNoOther) {
  auto session = noisy("P01");
  add(session);
  const auto whole = analyze_study(files_, {}, 1);
  session.subject = "P02";
  session.damaged_trial = 3;
  session.applied = noisy("P01").applied;
  const auto file = add(session);
  const auto damaged = analyze_study({file}, {}, 1);
  ASSERT_EQ(damaged.exclusions.size(), 1u);
  EXPECT_EQ(damaged.exclusions[0].trial, 3);
  EXPECT_THAT(damaged.exclusions[0].reason, HasSubstr("not all in the file"));
  ASSERT_EQ(damaged.scores.size(), 8u);
  EXPECT_EQ(damaged.scores.back().score, whole.scores.back().score);
  EXPECT_EQ(damaged.sessions[0].timing.missing, 1u);
}

TEST_F(Study, TakesASessionThatWasKilled) {
  auto session = noisy("P01");
  session.finished = false;
  session.clock = "real";
  write_session(folder_ / "P01.h5", session);
  const auto study = analyze_study({folder_ / "P01.h5.partial"}, {}, 1);
  EXPECT_EQ(study.scores.size(), 9u);
  EXPECT_FALSE(study.sessions[0].timing.complete);
  EXPECT_FALSE(study.sessions[0].timing.period);
}

TEST_F(Study, RefusesAStimulusOutOfOrder) {
  auto session = perfect();
  session.stimulus_backwards = true;
  add(session);
  try {
    analyze_study(files_, {}, 1);
    ADD_FAILURE() << "took a stimulus that runs backwards";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("P01.h5"));
    EXPECT_THAT(error.what(), HasSubstr("block 1"));
  }
}

TEST_F(Study, ReadsHowTheLoopKeptTime) {
  auto session = perfect();
  session.clock = "real";
  add(session);
  const auto timing = analyze_study(files_, {}, 1).sessions[0].timing;
  EXPECT_TRUE(timing.applies);
  EXPECT_TRUE(timing.complete);
  EXPECT_EQ(timing.overruns, 2u);
  EXPECT_EQ(timing.missing, 0u);
  // A hundred periods, 99 of them below 2 ms: upper edges of the bins.
  EXPECT_EQ(timing.period->median_ns, 2'000'000);
  EXPECT_EQ(timing.period->p99_ns, 2'000'000);
  EXPECT_EQ(timing.period->p999_ns, 3'000'000);
  EXPECT_EQ(timing.lateness->p99_ns, 1'000'000);
  EXPECT_EQ(timing.compute->highest_ns, 2'000'000);
}

TEST_F(Study, RefusesWhatIsNoStudy) {
  EXPECT_THROW(analyze_study({}, {}, 1), InputError);
  EXPECT_THROW(analyze_study({folder_ / "absent.h5"}, {}, 1), InputError);
  auto session = perfect();
  add(session);
  write_session(folder_ / "copy.h5", session);
  files_.push_back(folder_ / "copy.h5");
  try {
    analyze_study(files_, {}, 2);
    ADD_FAILURE() << "took two sessions of one subject";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("both of subject P01"));
  }
}

TEST_F(Study, TheSummaryIsOverParticipants) {
  for (const char* subject : {"P01", "P02"}) {
    add(noisy(subject));
  }
  const AnalysisPlan plan{{{"visuohaptic", "visual", Tail::kLess}}, ""};
  const auto lines = summary_lines(analyze_study(files_, {}, 1, plan));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_THAT(lines[0], HasSubstr("Haptic: mean recall error"));
  EXPECT_THAT(lines[2], HasSubstr("(2 simulated participants, 6 trials)"));
  EXPECT_THAT(lines[3], HasSubstr("F(2, 2)"));
  EXPECT_THAT(lines[4], HasSubstr("Planned, visuohaptic < visual: "));
  EXPECT_THAT(lines[4], HasSubstr("paired t(1)"));
}

const std::string kDefinition = "[hand]\nmass = 1.0\n[subject]\nweber = 0.1\n";

Identity identity_of(const std::string& definition, bool simulated = true, std::uint64_t seed = 1) {
  StudyResult study;
  study.sessions.emplace_back();
  auto& info = study.sessions.back().info;
  info.subject = "S1";
  info.simulated = simulated;
  info.seed = seed;
  info.definition = definition;
  return identities(study).at(0);
}

TEST(IdentityTest, SeedAndPopulationMakeAVirtualSubject) {
  const Identity one = identity_of(kDefinition);
  EXPECT_EQ(why_another(one, identity_of("# other words\n[subject]\nweber=1e-1\n[hand]\nmass=1\n")),
            "");
  EXPECT_EQ(why_another(one, identity_of(kDefinition + "[design]\ntrials = 3\n")), "");
  EXPECT_EQ(why_another(one, identity_of(kDefinition + "[pace]\npace = 1\n")), "");
  EXPECT_NE(why_another(one, identity_of("[hand]\nmass = 1.0\n[subject]\nweber = 0.2\n")), "");
  EXPECT_NE(why_another(one, identity_of("[hand]\nmass = 2.0\n[subject]\nweber = 0.1\n")), "");
  EXPECT_NE(why_another(one, identity_of(kDefinition, true, 2)), "");
  EXPECT_NE(why_another(identity_of(kDefinition + "[pace]\npace = 1\n"),
                        identity_of(kDefinition + "[pace]\npace = 2\n")),
            "");
}

TEST(IdentityTest, APersonIsTheIdentifier) {
  EXPECT_EQ(why_another(identity_of(kDefinition, false, 1), identity_of("", false, 2)), "");
  EXPECT_NE(why_another(identity_of(kDefinition, false), identity_of(kDefinition, true)), "");
}

TEST(IdentityTest, AVirtualSubjectWithoutADefinitionIsNobodyElse) {
  EXPECT_NE(why_another(identity_of(""), identity_of("")), "");
}

TEST(IdentityTest, ReadsBackFromJson) {
  const std::vector<Identity> all{identity_of(kDefinition, true, 18446744073709551615u),
                                  {"P\"2", false}};
  const auto read = identities_from(nlohmann::ordered_json::parse(to_json(all).dump()));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].seed, all[0].seed);
  EXPECT_EQ(read[0].population, all[0].population);
  EXPECT_EQ(read[0].population.size(), 2u);
  EXPECT_EQ(read[1].subject, "P\"2");
  EXPECT_FALSE(read[1].seed);
}

}  // namespace
}  // namespace haptrial::analysis
