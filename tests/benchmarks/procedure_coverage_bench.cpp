// Each procedure with virtual observers of known threshold: bias and standard deviation of its own
// estimate and of the maximum-likelihood fit of its trials, and how often their 95 % intervals hold
// the truth. The tables of docs/algorithms/procedure-coverage.md. The numbers do not depend on the
// number of threads.
//
//     bench_procedure_coverage [observers] [threads] [part of a name] [beta-binomial fits of each]
//     bench_procedure_coverage 1000 2 troubles  # lapses, false alarms, thresholds beyond the range

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/analysis/psychometric/fit/coverage_grid.h"
#include "tests/analysis/psychometric/fit/procedure_study.h"
#include "tests/analysis/psychometric/fit/surface_counts.h"

namespace {

using haptrial::test::ProcedureStudy;
using haptrial::test::StudyResult;
using haptrial::test::Tally;

double percent(int count, int of) { return 100.0 * count / std::max(of, 1); }

/// Bias, standard deviation, coverage and standard error of the coverage.
void print(const char* what, const Tally& t, const char* lacking) {
  if (t.observers == 0) {
    return;
  }
  fmt::print("    {:28} bias {:+.3f}  SD {:.3f}", what, t.bias(), t.deviation());
  if (t.open == t.observers) {
    fmt::print("  no interval\n");
    return;
  }
  const double share = t.coverage();
  fmt::print("  holds {:5.1f} % ± {:.1f}  {} {:.1f} %\n", 100.0 * share,
             100.0 * std::sqrt(share * (1.0 - share) / t.observers), lacking,
             percent(t.open, t.observers));
}

/// How often an interval of a fit holds the truth.
void print_held(const char* what, const Tally& t) {
  if (t.observers > 0) {
    const double share = t.coverage();
    fmt::print("    {:45} holds {:5.1f} % ± {:.1f}  open {:.1f} %\n", what, 100.0 * share,
               100.0 * std::sqrt(share * (1.0 - share) / t.observers),
               percent(t.open, t.observers));
  }
}

void report(const ProcedureStudy& study, int observers, int threads, int bayesian) {
  const StudyResult r = run_study(study, observers, threads, bayesian);
  fmt::print("{} ({:.0f} trials)\n", study.name, r.trials);
  print(("own estimate of " + study.meant).c_str(), r.natural, "without");
  print("own width, ln(found/true)", r.natural_width, "without");
  if (r.natural.observers > 0 && r.natural.observers < observers) {
    fmt::print("    no estimate for {:.1f} %\n",
               percent(observers - r.natural.observers, observers));
  }
  print("fit: threshold", r.threshold, "open");
  print("fit: ln(width/true)", r.width, "open");
  print_held("profile likelihood: threshold", r.profile);
  print_held("profile likelihood: width", r.profile_width);
  print_held("beta-binomial fit: threshold", r.bayesian);
  print_held("beta-binomial fit: width", r.bayesian_width);
  if (r.threshold.observers > 0) {
    auto widths = r.width.errors;
    std::nth_element(widths.begin(), widths.begin() + static_cast<long>(widths.size() / 2),
                     widths.end());
    fmt::print("    fit: median width {:.2f} of the true one, undetermined {:.1f} %\n",
               std::exp(widths[widths.size() / 2]), percent(r.undetermined, observers));
  }
}

/// QUEST+ of two variables: the posterior that a report of surfaces states.
void report_surfaces(int observers, int threads) {
  const auto c = haptrial::test::count_surfaces(observers, threads);
  fmt::print("QUEST+ of two variables (120 trials)\n");
  const char* const names[] = {"threshold", "gain", "spread"};
  for (std::size_t k = 0; k < c.held.size(); ++k) {
    fmt::print("    {:28} bias {:+.3f}  holds {:5.1f} %\n", names[k], c.error[k],
               percent(c.held[k], c.observers));
  }
  fmt::print("    contour                      holds {:5.1f} % of {}\n",
             percent(c.contours_held, c.contours), c.contours);
}

void print_count(const char* what, const haptrial::test::CoverageCount& c) {
  fmt::print("  {}: stated {:5.1f} %, holds {:5.1f} %, open {:5.1f} %", what,
             percent(c.stated, c.observers), percent(c.held, c.stated),
             percent(c.open, c.observers));
}

/// Reports the effect of trouble on the intervals that a report states.
void report_troubles(int observers, int threads) {
  for (const haptrial::test::CoverageCell& cell : haptrial::test::coverage_cells()) {
    const auto counts = haptrial::test::count_coverage(cell, observers, threads);
    fmt::print("{:9} {} place {} lapses {:.2f} false alarms {:.2f} correlation {:.2f}",
               cell.procedure, cell.alternatives, cell.place, cell.lapse, cell.false_alarms,
               cell.correlation);
    print_count("fit", counts.fit);
    print_count("own", counts.own);
    fmt::print("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int observers = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 2;
  const std::string part = argc > 3 ? argv[3] : "";
  const int bayesian = argc > 4 ? std::atoi(argv[4]) : 0;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  for (const ProcedureStudy& study : haptrial::test::procedure_studies()) {
    if (study.name.find(part) != std::string::npos) {
      report(study, observers, threads, bayesian);
    }
  }
  if (std::string("surfaces").find(part) != std::string::npos) {
    report_surfaces(observers, threads);
  }
  if (part == "troubles") {
    report_troubles(observers, threads);
  }
  return 0;
}
