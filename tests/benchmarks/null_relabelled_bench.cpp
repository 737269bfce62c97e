// How often the tests of the construct-validity report and of compare are below 0.05 when nothing
// has an effect: shipped results with their labels permuted or split at random.
//   bench_null_relabelled RESULTS [REPLICATIONS] [THREADS]
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"
#include "tests/analysis/bone_drilling/report/null_validity.h"
#include "tests/analysis/force_training/report/null_comparisons.h"

namespace {

void print(const char* scheme, const std::vector<haptrial::test::NullLevel>& levels,
           std::size_t studies) {
  for (const auto& level : levels) {
    // Several tests of one study depend on each other: no band for them.
    const auto band = haptrial::test::binomial_band(studies, 0.95);
    const char* where = level.replications != studies ? "-"
                        : level.found > band.high     ? "ABOVE"
                        : level.found < band.low      ? "below"
                                                      : "inside";
    fmt::print(
        "| {} | {}{} | {:.1f} % | {} |\n", scheme, level.test, level.leads ? " **(leads)**" : "",
        100.0 * static_cast<double>(level.found) / static_cast<double>(level.replications), where);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  namespace test = haptrial::test;
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_null_relabelled RESULTS [REPLICATIONS] [THREADS]\n");
    return 2;
  }
  const std::filesystem::path results = argv[1];
  const auto studies = static_cast<std::size_t>(argc > 2 ? std::atoi(argv[2]) : 400);
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const auto rated = test::read_rated_study(results / "construct_validity");
  for (const auto labels : {test::NullLabels::kGroups, test::NullLabels::kRatings}) {
    print(name_of(labels), test::null_validity(rated, labels, studies, 1, threads), studies);
  }
  print("groups of different spread", test::null_spreads(studies, 1, threads), studies);
  print("made-up regions", test::null_regions(studies, 1, threads), studies);
  const auto file = results / "force_training/scores.csv";
  const auto scores =
      haptrial::analysis::read_scores_csv(haptrial::file_text(file), file.string()).scores;
  for (const auto split : {test::NullSplit::kBlocks, test::NullSplit::kParticipants}) {
    print(name_of(split), test::null_comparisons(scores, split, studies, 1, threads), studies);
  }
  return 0;
}
