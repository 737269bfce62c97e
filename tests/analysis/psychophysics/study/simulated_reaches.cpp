#include "tests/analysis/psychophysics/study/simulated_reaches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/psychophysics/study/reach_quantities.h"
#include "analysis/psychophysics/study/trials_result.h"
#include "core/base/random.h"

namespace haptrial::test {

using namespace analysis::trials;

namespace {

constexpr std::array<const char*, 3> kBlocks{"before", "during", "after"};
constexpr double kLikeTheOneBefore = 0.3;

/// Noise of one participant's quantity: a mean of their own, and trials that are correlated.
class Wander {
 public:
  Wander(double mean, double between, double within, RandomStream& random)
      : own_(mean + between * random.normal()), within_(within), random_(random) {}
  double next() {
    last_ = kLikeTheOneBefore * last_ + within_ * random_.normal();
    return own_ + last_;
  }

 private:
  double own_, within_;
  double last_{0.0};
  RandomStream& random_;
};

void add_person(const SimulatedReaches& study, std::size_t person, ReachesOfStudy& made) {
  RandomStream random(study.seed, fmt::format("reaches {}", person));
  const bool second = person >= study.participants / 2;
  StudySession session;
  session.participant = fmt::format("P{:02}", person + 1);
  session.group = second ? "b" : "a";
  made.data.sessions.push_back(session);
  made.reaching.participants.push_back(session.participant);
  Wander error(0.002, 0.003, 0.006, random), time(0.5, 0.05, 0.04, random);
  Wander speed(0.4, 0.04, 0.03, random), direction(0.02, 0.03, 0.08, random);
  Wander area(1e-4, 1e-4, 3e-4, random), compensation(0.3, 0.1, 0.2, random);
  std::size_t order = 0;
  for (std::size_t b = 0; b < kBlocks.size(); ++b) {
    for (std::size_t i = 0; i < study.trials; ++i) {
      StudyTrial trial;
      trial.session = person;
      trial.block = static_cast<int>(b) + 1;
      trial.variables.push_back({"block", 0, kNotKnown, kBlocks[b]});
      StudyReach reach;
      reach.trial = made.data.trials.size();
      reach.order = order++;
      reach.block = kBlocks[b];
      reach.place = i;
      reach.recorded = true;
      reach.metrics.maximum_perpendicular_error = error.next() +
                                                  (second ? study.difference_of_groups : 0.0) +
                                                  static_cast<double>(b) * study.rise_of_blocks;
      reach.metrics.movement_time = time.next();
      reach.metrics.peak_speed = speed.next();
      reach.metrics.direction_error = direction.next();
      reach.metrics.signed_area = area.next();
      reach.way.target = {i % 2 == 0 ? 0.05 : 0.10, 0.0, 0.0};
      reach.metrics.endpoint_extent = 0.003 * random.normal();
      if (i % 4 == 3) {
        reach.kind = ReachKind::kClamp;
        analysis::ForceCompensation found{};
        found.slope = compensation.next();
        reach.compensation = found;
      }
      made.data.trials.push_back(std::move(trial));
      made.reaching.reaches.push_back(std::move(reach));
      made.reaching.persons.push_back(person);
      made.reaching.block_of.push_back(b);
    }
  }
}

}  // namespace

ReachesOfStudy simulated_reaches(const SimulatedReaches& study, const ReachingPlan& plan) {
  ReachesOfStudy made;
  made.reaching.plan = plan;
  for (std::size_t person = 0; person < study.participants; ++person) {
    add_person(study, person, made);
  }
  return made;
}

TrialsPlan reach_plan(const std::vector<std::string>& by) {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kReaching;
  plan.by = by;
  plan.permutations = 0;
  plan.reaching.quantities = {ReachQuantity::kError,     ReachQuantity::kMovementTime,
                              ReachQuantity::kPeakSpeed, ReachQuantity::kDirection,
                              ReachQuantity::kArea,      ReachQuantity::kForceCompensation,
                              ReachQuantity::kThroughput};
  std::vector<std::string> tests;
  for (const std::string& factor : by) {
    tests.emplace_back(factor == "group" ? "a < b" : "after > before");
  }
  plan.plan = analysis::parse_analysis_plan(tests, "", "tests");
  return plan;
}

std::vector<NullLevel> null_reaches(const std::vector<std::string>& by, std::size_t replications,
                                    std::uint64_t seed, int threads) {
  const TrialsPlan plan = reach_plan(by);
  return null_levels(replications, threads, [&](std::size_t number) {
    SimulatedReaches study;
    study.seed = derived_seed(seed, fmt::format("null reaches {}", number));
    const ReachesOfStudy made = simulated_reaches(study, plan.reaching);
    TrialsResult result;
    result.quantities = reach_quantities(made.data, made.reaching, plan);
    NullLevels levels;
    for (const analysis::NamedTest& test : tests_of(result)) {
      levels.note(test.name, true, test.p < 0.05);
    }
    return levels;
  });
}

}  // namespace haptrial::test
