// How often tests of conditions come out below 0.05 where there is no difference: labels of a study
// permuted, and studies simulated with its variances. Prints the table of
// docs/algorithms/mixed-model.md.
//   bench_null_conditions SCORES.csv [STUDIES] [SEED]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "analysis/scores_csv.h"
#include "core/base/file_text.h"
#include "tests/support/condition_null.h"

namespace {

using haptrial::test::NullCounts;
using haptrial::test::NullScheme;

std::string share(int count, int studies) {
  return fmt::format("{:.1f} %", 100.0 * count / studies);
}

std::string shares(const std::vector<int>& counts, int studies) {
  std::string text;
  for (const int count : counts) {
    text += (text.empty() ? "" : ", ") + share(count, studies);
  }
  return text;
}

void print(const char* scheme, const NullCounts& c) {
  const int n = c.studies;
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", scheme, share(c.omnibus, n),
             shares(c.differences, n), share(c.repeated, n), share(c.intercept_omnibus, n),
             shares(c.intercept_differences, n), share(c.pooled, n), share(c.boundary, n));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_null_conditions SCORES.csv [STUDIES] [SEED]\n");
    return 2;
  }
  const auto table = haptrial::analysis::read_scores_csv(haptrial::file_text(argv[1]), argv[1]);
  const int studies = argc > 2 ? std::atoi(argv[2]) : 400;
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoll(argv[3]) : 1);
  fmt::print(
      "| no difference, because | mixed model, F | its two coefficients | repeated measures, "
      "Greenhouse and Geisser | random intercept alone, F | its two coefficients | pooled trials, "
      "F "
      "| a variance at 0 |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  const auto start = std::chrono::steady_clock::now();
  for (const auto& [name, scheme] :
       {std::pair{"labels permuted over the blocks of each participant", NullScheme::kBlocks},
        std::pair{"names of the conditions permuted for each participant",
                  NullScheme::kParticipants},
        std::pair{"simulated with the study's variances", NullScheme::kSimulated}}) {
    print(name, haptrial::test::null_counts(table.scores, scheme, studies, seed));
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  fmt::print("{} studies of each kind, {} trials, seed {}: {:.1f} s\n", studies,
             table.scores.size(), seed, taken.count());
  return 0;
}
