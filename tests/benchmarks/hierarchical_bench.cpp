// bench_hierarchical STUDIES [THREADS] [SEED]: how fast hierarchical psychometric functions are
// sampled, whether ranks of the prior's numbers are uniform, and how often intervals hold the
// truth.

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "tests/analysis/psychometric/hierarchical/hierarchical_study.h"

namespace {

using namespace haptrial;
using namespace haptrial::analysis::hierarchical;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_speed(std::uint64_t seed) {
  test::HierarchicalStudy study = test::small_study();
  study.people = 20;
  study.levels = 10;
  study.trials = 30;
  RandomStream random(seed, "speed");
  const Model model =
      test::simulated_model(study, test::typical_people(study, 0.1, random), random);
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    Sampling sampling;
    sampling.seed = seed + static_cast<std::uint64_t>(run);
    const HierarchicalFit fit = hierarchical_fit(model, sampling);
    fmt::print(
        "20 people, 2 conditions, 300 trials: {:.2f} s, {} draws of each chain, R-hat up to "
        "{:.4f}, at least {:.0f} effective draws\n",
        seconds_since(start), fit.draws, fit.r_hat, fit.effective);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto studies = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 100);
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 1);
  print_speed(seed);
  const test::HierarchicalStudy study = test::small_study();
  const test::Calibration ranks = test::calibration(study, studies, seed, threads);
  for (std::size_t k = 0; k < ranks.names.size(); ++k) {
    fmt::print("{}: ranks of {} studies, p = {:.3f} of being uniform in 20 bins\n", ranks.names[k],
               studies, test::uniform_p(ranks.ranks[k], 20));
  }
  test::HierarchicalStudy people = study;
  people.people = 8;
  people.trials = 10;
  const test::Coverage held = test::coverage(people, studies, seed, threads);
  for (std::size_t k = 0; k < held.names.size(); ++k) {
    fmt::print("{}: {} of {} intervals hold the truth\n", held.names[k], held.held[k], studies);
  }
}
