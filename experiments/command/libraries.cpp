#include "experiments/command/libraries.h"

#include <H5public.h>
#include <fmt/format.h>
#include <gsl/gsl_version.h>
#include <sundials/sundials_version.h>

#include <Eigen/Core>
#include <array>

namespace haptrial::experiments {
namespace {

std::string hdf5() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string sundials() {
  std::array<char, 32> text{};
  SUNDIALSGetVersion(text.data(), static_cast<int>(text.size()));
  return text.data();
}

}  // namespace

std::string libraries() {
  return fmt::format("Eigen {}.{}.{}, HDF5 {}, GSL {}, SUNDIALS {}", EIGEN_WORLD_VERSION,
                     EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, hdf5(), gsl_version, sundials());
}

}  // namespace haptrial::experiments
