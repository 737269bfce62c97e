#include "core/base/matrix_functions.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace haptrial {
namespace {

TEST(MatrixFunctionsTest, TheRadiusOfKnownSpectra) {
  Eigen::Matrix3d turned;  // eigenvalues 0.5 and 2 (cos 1 +- i sin 1)
  turned << 2.0 * std::cos(1.0), -2.0 * std::sin(1.0), 7.0,  //
      2.0 * std::sin(1.0), 2.0 * std::cos(1.0), -3.0,        //
      0.0, 0.0, 0.5;
  EXPECT_NEAR(spectral_radius(turned), 2.0, 1e-12);
  Eigen::Matrix3d companion;  // z³ - 6 z² + 11 z - 6 = (z - 1) (z - 2) (z - 3)
  companion << 6.0, -11.0, 6.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  EXPECT_NEAR(spectral_radius(companion), 3.0, 1e-12);
  EXPECT_EQ(spectral_radius(Eigen::MatrixXd::Zero(4, 4)), 0.0);
  EXPECT_NEAR(std::abs(std::arg(dominant_eigenvalue(turned))), 1.0, 1e-12);
}

// A mass on a spring, however stiff it is beside the tick: cosines, and decay of what is damped.
TEST(MatrixFunctionsTest, TheExponentialMovesAMassOnASpring) {
  for (const double w : {0.01, 1.0, 40.0}) {
    const Eigen::Matrix2d flow{{0.0, 1.0}, {-w * w, 0.0}};
    const Eigen::MatrixXd step = matrix_exponential(flow);
    EXPECT_NEAR(step(0, 0), std::cos(w), 1e-11);
    EXPECT_NEAR(step(0, 1), std::sin(w) / w, 1e-11);
    EXPECT_NEAR(step(1, 0) / w, -std::sin(w), 1e-11);
  }
  EXPECT_NEAR(matrix_exponential(Eigen::MatrixXd::Constant(1, 1, -3.0))(0, 0), std::exp(-3.0),
              1e-15);
}

TEST(MatrixFunctionsTest, OnlySquareFiniteMatrices) {
  EXPECT_THROW(spectral_radius(Eigen::MatrixXd(2, 3)), std::invalid_argument);
  EXPECT_THROW(matrix_exponential(Eigen::MatrixXd(0, 0)), std::invalid_argument);
  EXPECT_THROW(spectral_radius(Eigen::MatrixXd::Constant(2, 2, NAN)), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial
