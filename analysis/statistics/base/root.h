#pragma once

#include <functional>

namespace haptrial::analysis {

/// Zero of f between low and high, to the last digits of a double (Brent's method).
/// @throws std::invalid_argument when f has the same sign at both ends or is not finite there.
double find_root(const std::function<double(double)>& f, double low, double high);

}  // namespace haptrial::analysis
