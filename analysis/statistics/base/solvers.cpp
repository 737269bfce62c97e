#include "analysis/statistics/base/solvers.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

using Function = std::function<double(std::span<const double>)>;

/// The coordinates are scaled so that the first simplex has steps of 1.
struct Scaled {
  const Function& f;
  std::span<const double> steps;
  std::vector<double> point;

  double operator()(const gsl_vector* x) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      point[i] = gsl_vector_get(x, i) * steps[i];
    }
    const double value = f(point);
    return std::isfinite(value) ? value : std::numeric_limits<double>::max();
  }
};

double call_scaled(const gsl_vector* x, void* scaled) { return (*static_cast<Scaled*>(scaled))(x); }

struct FreeVector {
  void operator()(gsl_vector* v) const { gsl_vector_free(v); }
};
using Vector = std::unique_ptr<gsl_vector, FreeVector>;

/// One run; moves `x` to where it ends.
double descend(gsl_multimin_function& function, gsl_vector* x, double size) {
  const Vector first(gsl_vector_alloc(x->size));
  gsl_vector_set_all(first.get(), 1.0);
  const std::unique_ptr<gsl_multimin_fminimizer, decltype(&gsl_multimin_fminimizer_free)> search(
      gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, x->size),
      gsl_multimin_fminimizer_free);
  gsl_multimin_fminimizer_set(search.get(), &function, x, first.get());
  const std::size_t most = 1000 * x->size;
  for (std::size_t i = 0; i < most; ++i) {
    if (gsl_multimin_fminimizer_iterate(search.get()) != GSL_SUCCESS ||
        gsl_multimin_fminimizer_size(search.get()) < size) {
      break;
    }
  }
  gsl_vector_memcpy(x, gsl_multimin_fminimizer_x(search.get()));
  return gsl_multimin_fminimizer_minimum(search.get());
}

}  // namespace

Minimum find_minimum(const Function& f, std::span<const double> start,
                     std::span<const double> steps, double size) {
  if (start.empty() || start.size() != steps.size()) {
    throw std::invalid_argument("find_minimum: start and steps must be as many, at least one");
  }
  constexpr int kRuns = 20;
  constexpr double kGain = 1e-11;
  Scaled scaled{f, steps, std::vector<double>(start.size())};
  gsl_multimin_function function{call_scaled, start.size(), &scaled};
  const Vector x(gsl_vector_alloc(start.size()));
  for (std::size_t i = 0; i < start.size(); ++i) {
    gsl_vector_set(x.get(), i, start[i] / steps[i]);
  }
  double value = descend(function, x.get(), size);
  for (int run = 1; run < kRuns; ++run) {
    const double again = descend(function, x.get(), size);
    const bool done = !(again < value - kGain * (1.0 + std::abs(value)));
    value = again;
    if (done) {
      break;
    }
  }
  scaled(x.get());
  return {scaled.point, value};
}

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
