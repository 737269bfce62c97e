#pragma once

#include <cmath>

namespace haptrial::psychometric {

/// -p log p, 0 at 0 [nat]: what an outcome adds to an entropy.
inline double surprise(double p) noexcept { return p > 0.0 ? -p * std::log(p) : 0.0; }

}  // namespace haptrial::psychometric
