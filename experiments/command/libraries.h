#pragma once

#include <string>

namespace haptrial::experiments {

/// Libraries that results depend on, each with its version as it is loaded or was compiled in:
/// "Eigen 3.4.0, HDF5 1.10.8, ...".
std::string libraries();

}  // namespace haptrial::experiments
