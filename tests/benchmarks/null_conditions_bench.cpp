// How often tests of conditions come out below 0.05 without a difference: the labels of a study
// permuted, and studies simulated with its variances. Prints the table of
// docs/algorithms/mixed-model.md; with P.csv also writes every p value, for null_conditions.gp.
//   bench_null_conditions SCORES.csv [STUDIES] [SEED] [P.csv]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <fstream>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"
#include "tests/support/condition_null.h"

namespace {

using haptrial::test::NullScheme;
using haptrial::test::NullTests;
using Studies = std::vector<NullTests>;

template <class P>
std::string share(const Studies& studies, P&& p) {
  return fmt::format("{:.1f} %", 100.0 * haptrial::test::count_below(studies, p) /
                                     static_cast<double>(studies.size()));
}

template <class P>
std::string shares(const Studies& studies, P&& p) {
  return share(studies, [&](const auto& s) { return p(s)[0]; }) + ", " +
         share(studies, [&](const auto& s) { return p(s)[1]; });
}

struct Row {
  NullScheme scheme;
  const char* name;
  std::size_t participants;
};

constexpr const char* kBlocks = "labels permuted over the blocks of each participant";
constexpr const char* kNames = "names of the conditions permuted for each participant";
constexpr const char* kSimulated = "simulated with the study's variances";
constexpr const char* kMissing = "the same with 30 % of the trials and a whole cell missing";
constexpr Row kRows[]{
    {NullScheme::kBlocks, kBlocks, 12},       {NullScheme::kParticipants, kNames, 12},
    {NullScheme::kSimulated, kSimulated, 12}, {NullScheme::kMissing, kMissing, 12},
    {NullScheme::kBlocks, kBlocks, 4},        {NullScheme::kParticipants, kNames, 4},
    {NullScheme::kSimulated, kSimulated, 4},  {NullScheme::kMissing, kMissing, 4}};

void print(const Row& row, const Studies& studies) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.name, row.participants,
             share(studies, [](const auto& s) { return s.mixed; }),
             shares(studies, [](const auto& s) { return s.differences; }),
             share(studies, [](const auto& s) { return s.repeated; }),
             share(studies, [](const auto& s) { return s.intercept; }),
             shares(studies, [](const auto& s) { return s.intercept_differences; }),
             share(studies, [](const auto& s) { return s.pooled; }),
             share(studies, [](const auto& s) { return s.at_boundary ? 0.0 : 1.0; }));
  std::fflush(stdout);
}

void write(std::ofstream& out, const Row& row, const Studies& studies) {
  for (const NullTests& s : studies) {
    out << fmt::format("{},{},{},{},{},{}\n", static_cast<int>(row.scheme), row.participants,
                       s.mixed, s.repeated, s.intercept, s.pooled);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_null_conditions SCORES.csv [STUDIES] [SEED] [P.csv]\n");
    return 2;
  }
  const auto table = haptrial::analysis::read_scores_csv(haptrial::file_text(argv[1]), argv[1]);
  const int studies = argc > 2 ? std::atoi(argv[2]) : 400;
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoll(argv[3]) : 1);
  std::ofstream out;
  if (argc > 4) {
    out.open(argv[4]);
    out << "scheme,participants,mixed,repeated,intercept,pooled\n";
  }
  fmt::print(
      "| why there is no difference | participants | mixed model: F | its coefficients | repeated "
      "measures, "
      "Greenhouse–Geisser: F | random intercept alone: F | its coefficients | pooled trials: F | "
      "a variance at 0 |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  const auto start = std::chrono::steady_clock::now();
  for (const Row& row : kRows) {
    const auto scores = haptrial::test::of_participants(table.scores, row.participants);
    const Studies made = haptrial::test::null_studies(scores, row.scheme, studies, seed);
    print(row, made);
    write(out, row, made);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  fmt::print("{} studies of each kind, {} trials, seed {}: {:.1f} s\n", studies,
             table.scores.size(), seed, taken.count());
  return 0;
}
