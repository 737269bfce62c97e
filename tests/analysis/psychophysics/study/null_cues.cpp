#include "tests/analysis/psychophysics/study/null_cues.h"

#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

namespace haptrial::test {
namespace {

using namespace analysis::trials;
using analysis::TTest;

constexpr std::array kNames{"weight", "log sd", "better than the better one"};

using Tests = std::array<analysis::Defined<TTest>, 3>;

Tests tests_of_study(CueUse use, std::uint64_t seed) {
  SimulatedCues study;
  study.use = use;
  study.seed = seed;
  const CueStudy cues = studied(simulated_cues(study), plan_of(study));
  const CueLevel& level = cues.levels.at(0);
  return {level.weight.test, level.log_sd.test, level.beats_best.test};
}

}  // namespace

CueStudy studied(const TrialsData& data, const TrialsPlan& plan) {
  const auto series = series_of(data, plan);
  std::vector<FunctionFit> fits;
  for (const AnsweredSeries& each : series) {
    fits.push_back(fit_series(each, plan, 1));
  }
  return cue_study(data, series, fits, plan);
}

const NullCueTest& NullCues::of(const std::string& name) const {
  for (const NullCueTest& test : tests) {
    if (test.name == name) {
      return test;
    }
  }
  throw std::out_of_range(name);
}

NullCues null_cues(CueUse use, std::size_t replications, std::uint64_t seed, int threads) {
  std::vector<Tests> studies(replications,
                             Tests{analysis::Undefined{"not yet"}, analysis::Undefined{"not yet"},
                                   analysis::Undefined{"not yet"}});
  {
    std::vector<std::jthread> workers;
    const auto step = static_cast<std::size_t>(threads);
    for (std::size_t first = 0; first < step; ++first) {
      workers.emplace_back([&, first] {
        for (std::size_t i = first; i < replications; i += step) {
          studies[i] = tests_of_study(use, seed + i);
        }
      });
    }
  }
  NullCues result;
  for (std::size_t t = 0; t < kNames.size(); ++t) {
    NullCueTest& made = result.tests[t];
    made.name = kNames[t];
    double squares = 0.0;
    for (const Tests& study : studies) {
      if (study[t]) {
        ++made.replications;
        made.found += study[t]->p < 0.05 ? 1 : 0;
        made.mean += study[t]->difference;
        squares += study[t]->difference * study[t]->difference;
      }
    }
    const auto n = static_cast<double>(made.replications);
    made.mean /= n;
    made.error = std::sqrt((squares / n - made.mean * made.mean) / n);
  }
  return result;
}

}  // namespace haptrial::test
