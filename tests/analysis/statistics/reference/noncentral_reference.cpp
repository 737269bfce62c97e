#include <fmt/format.h>

#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/base/solvers.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::noncentral_reference {
namespace {

// R is right to 1e-12 absolute: smaller probabilities were left out.
std::vector<double> kept(const std::vector<double>& p) {
  std::vector<double> result;
  for (const double value : p) {
    if (value > 1e-3) {
      result.push_back(value);
    }
  }
  return result;
}

void compare_t(Answers& r) {
  for (const double df : {1.0, 2.0, 5.5, 11.0, 31.0, 574.0}) {
    for (const double delta : {-3.0, -0.4, 0.2, 2.5, 9.0, 30.0}) {
      std::vector<double> p;
      for (const double t : {-6.0, -1.0, 0.3, 2.0, 8.0, 33.0}) {
        p.push_back(noncentral_t(t, df, delta).lower);
      }
      r.at("Noncentral t", fmt::format("lower {:g} {:g}", df, delta)).are("p", kept(p));
    }
  }
}

void compare_f(Answers& r) {
  for (const double n : {1.0, 2.0, 7.5, 40.0}) {
    for (const double df : {3.0, 11.0, 31.0, 574.0}) {
      for (const double lambda : {0.1, 3.0, 40.0, 600.0}) {
        std::vector<double> p;
        for (const double f : {0.05, 0.8, 2.0, 7.0, 60.0}) {
          p.push_back(noncentral_f(f, n, df, lambda).lower);
        }
        r.at("Noncentral F", fmt::format("lower {:g} {:g} {:g}", n, df, lambda)).are("p", kept(p));
      }
    }
  }
}

// Place at which our lower tail has R's probability.
double quantile(double p, double n, double df, double lambda) {
  return find_root([&](double f) { return noncentral_f(f, n, df, lambda).lower - p; }, 0.0, 1e5);
}

void compare_quantiles(Answers& r) {
  for (const double n : {1.0, 2.0, 7.5, 40.0}) {
    for (const double df : {3.0, 11.0, 31.0, 574.0}) {
      for (const double lambda : {0.1, 3.0, 40.0}) {
        std::vector<double> q;
        for (const double p : {0.05, 0.5, 0.95}) {
          q.push_back(quantile(p, n, df, lambda));
        }
        r.at("Noncentral F", fmt::format("quantile {:g} {:g} {:g}", n, df, lambda)).are("q", q);
      }
    }
  }
}

void compare(Answers& r) {
  compare_t(r);
  compare_f(r);
  compare_quantiles(r);
}

const Topic kTopic("noncentral", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::noncentral_reference
