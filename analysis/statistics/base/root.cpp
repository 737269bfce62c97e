#include "analysis/statistics/base/root.h"

#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

double call(double x, void* f) { return (*static_cast<std::function<double(double)>*>(f))(x); }

}  // namespace

double find_root(const std::function<double(double)>& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low == 0.0) {
    return low;
  }
  if (at_high == 0.0) {
    return high;
  }
  if (!(at_low * at_high < 0.0) && std::signbit(at_low) == std::signbit(at_high)) {
    throw std::invalid_argument("find_root: there is no change of sign");
  }
  if (!std::isfinite(at_low) || !std::isfinite(at_high)) {
    throw std::invalid_argument("find_root: the function is not finite at an end");
  }
  auto copy = f;
  gsl_function function{call, &copy};
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_root_fsolver_set(solver.get(), &function, low, high);
  constexpr int kMost = 400;
  for (int i = 0; i < kMost; ++i) {
    gsl_root_fsolver_iterate(solver.get());
    const double a = gsl_root_fsolver_x_lower(solver.get());
    const double b = gsl_root_fsolver_x_upper(solver.get());
    const double root = gsl_root_fsolver_root(solver.get());
    if (f(root) == 0.0 || b - a <= 4.0 * std::numeric_limits<double>::epsilon() *
                                       std::max(std::abs(a), std::abs(b))) {
      return root;
    }
  }
  return gsl_root_fsolver_root(solver.get());
}

}  // namespace haptrial::analysis
