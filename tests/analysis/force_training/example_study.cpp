#include "tests/analysis/force_training/example_study.h"

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

constexpr double kSeconds = 14.0;

double pattern(double t) { return 5.0 + 3.0 * std::sin(0.9 * t) + 1.5 * std::sin(2.1 * t + 1.0); }

RecallPicture picture(const std::string& which, const TrialScore& score) {
  RecallPicture p{which, score, kSeconds};
  constexpr std::size_t kBase = 1000;
  for (std::size_t i = 0; i < kBase; ++i) {
    const double t = kSeconds * static_cast<double>(i) / (kBase - 1);
    p.target.push_back(pattern(t));
    p.applied.push_back(0.9 * pattern(t - 0.4));
    p.warped.push_back(0.9 * pattern(t));
    p.pairs.emplace_back(i, std::min<std::size_t>(i + 28, kBase - 1));
  }
  return p;
}

void add_trials(StudyResult& study, const std::string& subject, RandomStream& random) {
  const char* conditions[] = {"haptic", "visual", "visuohaptic"};
  const double participant = 0.3 * random.normal();
  for (std::int32_t trial = 1; trial <= 18; ++trial) {
    const std::int32_t block = (trial - 1) / 3 + 1;
    const std::int32_t c = (block - 1) % 3;
    const std::int32_t repetition = (trial - 1) % 3 + 1;
    const double score =
        3.0 - 0.6 * c - 0.15 * repetition + participant + 0.4 * std::abs(random.normal());
    study.scores.push_back({subject, conditions[c], trial, block, repetition, score, 0.4 * score,
                            0.8 * score, 1.1 * score, 1.7 * score});
  }
}

SessionSummary session(const std::string& subject, bool simulated) {
  SessionSummary s;
  s.file = subject + ".h5";
  s.info.subject = subject;
  s.info.program_version = "0.1.0";
  s.info.program_commit = "0123abc";
  s.info.definition = "name = \"example\"\n";
  s.info.definition_name = "example.toml";
  s.info.device = simulated ? "virtual" : "omega.3";
  s.info.clock = simulated ? "simulated" : "real";
  s.info.start_utc = "2026-11-20T09:30:00Z";
  s.info.simulated = simulated;
  s.test_passes = 19;
  s.scored = 18;
  s.tracking = {subject, 37, 0, 0.0123, 0.0004, 0.0011, 0.0007};
  s.timing.applies = !simulated;
  s.timing.complete = true;
  s.timing.ticks = 1'000'000;
  s.timing.overruns = simulated ? 0 : 3;
  if (!simulated) {
    s.timing.period = TimingPercentiles{1'000'000, 1'020'000, 1'080'000, 1'500'000};
  }
  return s;
}

}  // namespace

StudyResult example_study(bool simulated) {
  StudyResult study;
  RandomStream random(17, "example study");
  for (int i = 1; i <= 6; ++i) {
    const std::string subject = "P0" + std::to_string(i);
    add_trials(study, subject, random);
    study.sessions.push_back(session(subject, simulated));
    study.exclusions.push_back({subject, 19, "aborted"});
  }
  StudyQuestions questions;
  questions.plan.tests = {{"visual", "haptic", Tail::kLess},
                          {"visuohaptic", "visual", Tail::kLess}};
  questions.resampling.count = 199;
  study.statistics = study_statistics(study.scores, questions);
  study.tracking = {"all", 222, 0, 0.0123, 0.0004, 0.0011, 0.0007};
  study.recalls = {picture("best", study.scores[3]), picture("median", study.scores[7]),
                   picture("worst", study.scores[11])};
  for (int k = 0; k <= 100; ++k) {
    const double t = kSeconds * k / 100.0;
    study.stimulus.push_back(
        {1, t, {0.1 * k / 100.0 - 0.05, 0.0, 0.03 * std::sin(0.8 * t)}, pattern(t)});
  }
  study.parameters = {{"samples of the common time base", "1000"}, {"box filter", "0.1 s"}};
  return study;
}

}  // namespace haptrial::analysis
