// How often each test of a study's report is below 0.05 when conditions have no effect: conditions
// are given at random to the scores of a study, design by design. Prints a table in Markdown.
//   bench_null_reports SCORES.csv [REPLICATIONS] [THREADS] [DESIGN 0 to 5; all if left out]
#include <fmt/format.h>

#include <cstdlib>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"
#include "tests/analysis/force_training/study/null_reports.h"

int main(int argc, char** argv) {
  using haptrial::test::NullDesign;
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_null_reports SCORES.csv [REPLICATIONS] [THREADS] [DESIGN]\n");
    return 2;
  }
  const auto replications = static_cast<std::size_t>(argc > 2 ? std::atoi(argv[2]) : 400);
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const int only = argc > 4 ? std::atoi(argv[4]) : -1;
  const auto scores =
      haptrial::analysis::read_scores_csv(haptrial::file_text(argv[1]), argv[1]).scores;
  for (const NullDesign design :
       {NullDesign::kOverBlocks, NullDesign::kByParticipant, NullDesign::kBetween,
        NullDesign::kMixed, NullDesign::kTwoWithin, NullDesign::kTwoBetween}) {
    if (only >= 0 && only != static_cast<int>(design)) {
      continue;
    }
    const auto counts = haptrial::test::null_reports(scores, design, replications, 1, threads);
    for (const auto& count : counts) {
      const auto band = haptrial::test::binomial_band(count.replications, 0.95);
      const bool kept = count.found >= band.low && count.found <= band.high;
      fmt::print("| {} | {}{} | {:.1f} % | {} |\n", name_of(design), count.test,
                 count.leads ? " **(leads)**" : "",
                 100.0 * static_cast<double>(count.found) / static_cast<double>(count.replications),
                 kept                     ? "inside"
                 : count.found < band.low ? "below"
                                          : "ABOVE");
    }
    std::fflush(stdout);
  }
  return 0;
}
