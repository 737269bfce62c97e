#include <fmt/format.h>

#include "analysis/statistics/base/distributions.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::distributions_reference {
namespace {

using Values = std::vector<double>;

const Values kT{-8, -2.5, -0.3, 0, 0.01, 0.7, 1.96, 4.2, 11, 40};
const Values kDf{1, 2.94, 5, 11, 22, 29.5, 31, 47.3, 100, 574, 861};
const Values kP{1e-10, 1e-4, 0.005, 0.025, 0.3, 0.5, 0.6, 0.9, 0.975, 0.9995, 1 - 1e-9};
const Values kF{1e-4, 0.2, 1, 2.7, 9, 60, 400};
const Values kChiSquared{1e-3, 0.4, 2, 7, 31, 250};

template <class Function>
Values mapped(const Values& values, Function&& function) {
  Values result;
  for (const double v : values) {
    result.push_back(function(v));
  }
  return result;
}

void compare(Answers& r) {
  for (const double df : kDf) {
    const auto name = fmt::format("df {:g}", df);
    r.at("Student's t: upper tail", name).are("p", mapped(kT, [&](double t) {
                                                return t_upper_tail(t, df);
                                              }));
    r.at("Student's t: quantile", name).are("t", mapped(kP, [&](double p) {
                                              return t_quantile(p, df);
                                            }));
    for (const double n : {1.0, 1.37, 2.0, 4.0, 8.0, 30.0}) {
      r.at("F: upper tail", fmt::format("df {:g} and {:g}", n, df))
          .are("p", mapped(kF, [&](double f) { return f_upper_tail(f, n, df); }));
    }
  }
  r.at("Normal: upper tail", "z").are("p", mapped(kT, normal_upper_tail));
  r.at("Normal: quantile", "p").are("z", mapped(kP, normal_quantile));
  for (const double df : {1.0, 2.0, 5.0, 9.0, 31.0, 100.0}) {
    r.at("Chi squared: upper tail", fmt::format("df {:g}", df))
        .are("p", mapped(kChiSquared, [&](double x) { return chi_squared_upper_tail(x, df); }));
  }
}

const Topic kTopic("distributions", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::distributions_reference
