#pragma once

// The one place that knows the power p of the local error
//
//     e(i,j) = w_f |F_i - G_j|^p + w_s |F'_i - G'_j|^p.

#include <cmath>

namespace haptrial::analysis {

/// |x|^p. Ops gives the number type (double, or a vector of floats) and its absolute value.
template <int power, class Ops>
[[gnu::always_inline]] inline typename Ops::Number powered(typename Ops::Number x) {
  static_assert(power == 1 || power == 2);
  if constexpr (power == 1) {
    return Ops::absolute(x);
  } else {
    return x * x;
  }
}

/// s with w |x|^p = |s x|^p: curves are scaled once instead of every cell.
[[gnu::always_inline]] inline double scale_of_weight(double weight, int power) {
  return power == 1 ? weight : std::sqrt(weight);
}

struct DoubleOps {
  using Number = double;
  static Number absolute(Number x) { return std::abs(x); }
};

/// Whether a few operations give |x|^p.
inline bool has_short_power(double p) {
  return p == 1.0 || p == 1.5 || p == 2.0 || p == 3.0 || p == 4.0;
}

/// use(f) with f(x) = |x|^p in double precision: by a few operations for the powers that people
/// take, by pow() for the rest.
template <class Use>
auto with_power(double p, Use use) {
  if (p == 1.0) {
    return use([](double x) { return powered<1, DoubleOps>(x); });
  }
  if (p == 2.0) {
    return use([](double x) { return powered<2, DoubleOps>(x); });
  }
  if (p == 1.5) {
    return use([](double x) { return std::abs(x) * std::sqrt(std::abs(x)); });
  }
  if (p == 3.0) {
    return use([](double x) { return std::abs(x) * (x * x); });
  }
  if (p == 4.0) {
    return use([](double x) { return (x * x) * (x * x); });
  }
  return use([p](double x) { return std::pow(std::abs(x), p); });
}

}  // namespace haptrial::analysis
