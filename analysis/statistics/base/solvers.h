#pragma once

#include <functional>
#include <span>
#include <vector>

namespace haptrial::analysis {

struct Minimum {
  std::vector<double> at;
  double value{0.0};
};

/// A local minimum of f without derivatives: the simplex of Nelder and Mead (GSL), begun again at
/// its end until it gains nothing. Not finite counts as very large.
/// @param steps  of the first simplex along each coordinate; as many as `start`, not 0.
/// @param size   of the last simplex, in units of `steps` as it is given.
/// @throws std::invalid_argument when the lengths differ or there are none.
Minimum find_minimum(const std::function<double(std::span<const double>)>& f,
                     std::span<const double> start, std::span<const double> steps,
                     double size = 1e-7);

/// Zero of f between low and high, to the last digits of a double (Brent's method).
/// @throws std::invalid_argument when f has the same sign at both ends or is not finite there.
double find_root(const std::function<double(double)>& f, double low, double high);

}  // namespace haptrial::analysis
