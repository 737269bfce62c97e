#pragma once

#include "core/base/require.h"

namespace haptrial::scene {

/// A length or size that may be infinite but neither 0 nor NaN.
inline bool is_positive(double x) noexcept { return x > 0.0; }

}  // namespace haptrial::scene
