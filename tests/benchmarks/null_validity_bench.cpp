// How often the construct-validity study finds a difference between virtual surgeons of one skill:
// every run simulates 15 people of its own, so that runs are independent.
//   bench_null_validity STUDY.toml NEW_FOLDER [RUNS] [SECONDS]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/null_study.h"

namespace {

namespace fs = std::filesystem;
using haptrial::test::NullFigures;
using haptrial::test::NullStudy;

/// How much of the variance of a rating is the person's, from two procedures of everybody.
double persons_share(const std::vector<std::vector<double>>& ratings) {
  double sum = 0.0;
  double within = 0.0;
  for (const auto& person : ratings) {
    sum += person[0] + person[1];
    within += 0.5 * std::pow(person[0] - person[1], 2);
  }
  const auto n = static_cast<double>(ratings.size());
  const double mean = sum / (2.0 * n);
  double between = 0.0;
  for (const auto& person : ratings) {
    between += 2.0 * std::pow(0.5 * (person[0] + person[1]) - mean, 2);
  }
  within /= n;
  between /= n - 1.0;
  return (between - within) / (between + within);
}

void print(const char* groups, int runs, const NullFigures& f) {
  fmt::print(
      "{} runs of 15 people, {}; p < 0.05: Student over procedures {}, Welch over means {}, "
      "mixed model {}\n",
      runs, groups, f.pooled, f.means, f.mixed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_null_validity STUDY.toml NEW_FOLDER [RUNS] [SECONDS]\n");
    return 2;
  }
  NullStudy study;
  const int runs = argc > 3 ? std::atoi(argv[3]) : 200;
  study.seconds = argc > 4 ? std::atof(argv[4]) : study.seconds;
  study.jobs = 1;
  const fs::path folder = argv[2];
  const auto d = haptrial::test::null_experiment(argv[1], folder, study);
  NullFigures as_defined;
  NullFigures drawn;
  for (int run = 1; run <= runs; ++run) {
    study.seed = static_cast<std::uint64_t>(run);
    const fs::path sessions = folder / fmt::format("run-{}", run);
    const auto ratings = haptrial::test::null_ratings(d, sessions, study);
    fs::remove_all(sessions);
    std::vector<std::size_t> order = haptrial::test::in_order(ratings.size());
    haptrial::test::count_run(ratings, order, as_defined);
    haptrial::RandomStream random(study.seed, "null studies");
    haptrial::test::shuffle_first(order, random);
    haptrial::test::count_run(ratings, order, drawn);
    drawn.ratings.insert(drawn.ratings.end(), ratings.begin(), ratings.end());
    if (run % 20 == 0 || run == runs) {
      print("grouped as the definition says", run, as_defined);
      print("groups drawn at random", run, drawn);
      fmt::print("a person's share of the variance of a rating: {:.2f}\n",
                 persons_share(drawn.ratings));
      std::fflush(stdout);
    }
  }
  return 0;
}
