// bench_hierarchical STUDIES [THREADS] [SEED] [speed|ranks|intervals]: how fast hierarchical
// psychometric functions are sampled, whether ranks of the prior's numbers are uniform, and how
// often intervals hold the truth.

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <string>

#include "tests/analysis/psychometric/hierarchical/hierarchical_study.h"

namespace {

using namespace haptrial;
using namespace haptrial::analysis::hierarchical;

void print_speed(std::uint64_t seed) {
  test::HierarchicalStudy study = test::small_study();
  study.people = 20;
  study.levels = 10;
  study.trials = 30;
  for (std::uint64_t run = seed; run < seed + 8; ++run) {
    RandomStream random(run, "speed");
    const Model model =
        test::simulated_model(study, test::typical_people(study, 0.1, random), random);
    Sampling sampling;
    sampling.seed = run;
    const std::clock_t start = std::clock();
    const HierarchicalFit fit = hierarchical_fit(model, sampling);
    fmt::print(
        "20 people, 2 conditions, 300 trials: {:.2f} s of processor time, {} draws of each "
        "chain, R-hat up to {:.4f}, at least {:.0f} effective draws\n",
        static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, fit.draws, fit.r_hat,
        fit.effective);
  }
}

void print_ranks(std::size_t studies, int threads, std::uint64_t seed) {
  const test::Calibration ranks = test::calibration(test::small_study(), studies, seed, threads);
  for (std::size_t k = 0; k < ranks.names.size(); ++k) {
    fmt::print("{}: ranks of {} studies, p = {:.3f} of being uniform in 20 bins\n", ranks.names[k],
               studies, test::uniform_p(ranks.ranks[k], 20));
  }
}

void print_intervals(std::size_t studies, int threads, std::uint64_t seed) {
  test::HierarchicalStudy people = test::small_study();
  people.people = 8;
  people.trials = 10;
  const test::Coverage held = test::coverage(people, studies, seed, threads);
  for (std::size_t k = 0; k < held.names.size(); ++k) {
    fmt::print("{}: {} of {} intervals hold the truth\n", held.names[k], held.held[k], studies);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto studies = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 100);
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 1);
  const std::string part = argc > 4 ? argv[4] : "";
  if (part.empty() || part == "speed") {
    print_speed(seed);
  }
  if (part.empty() || part == "ranks") {
    print_ranks(studies, threads, seed);
  }
  if (part.empty() || part == "intervals") {
    print_intervals(studies, threads, seed);
  }
}
