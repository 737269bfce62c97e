// Each procedure with virtual observers of known threshold: bias and standard deviation of its own
// estimate and of the maximum-likelihood fit of its trials, and how often their 95 % intervals hold
// the truth. The tables of docs/algorithms/procedure-coverage.md. The numbers do not depend on the
// number of threads.
//
//     bench_procedure_coverage [observers] [threads] [part of a name]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/analysis/psychometric/fit/procedure_study.h"

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

void report(const ProcedureStudy& study, int observers, int threads) {
  const StudyResult r = run_study(study, observers, threads);
  fmt::print("{} ({:.0f} trials)\n", study.name, r.trials);
  print(("own estimate of " + study.meant).c_str(), r.natural, "without");
  print("own width, ln(found/true)", r.natural_width, "without");
  if (r.natural.observers > 0 && r.natural.observers < observers) {
    fmt::print("    no estimate for {:.1f} %\n",
               percent(observers - r.natural.observers, observers));
  }
  print("fit: threshold", r.threshold, "open");
  print("fit: ln(width/true)", r.width, "open");
  if (r.threshold.observers > 0) {
    auto widths = r.width.errors;
    std::nth_element(widths.begin(), widths.begin() + static_cast<long>(widths.size() / 2),
                     widths.end());
    fmt::print("    fit: median width {:.2f} of the true one, undetermined {:.1f} %\n",
               std::exp(widths[widths.size() / 2]), percent(r.undetermined, observers));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int observers = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 2;
  const std::string part = argc > 3 ? argv[3] : "";
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  for (const ProcedureStudy& study : haptrial::test::procedure_studies()) {
    if (study.name.find(part) != std::string::npos) {
      report(study, observers, threads);
    }
  }
  return 0;
}
