#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

namespace haptrial::test {

/// Properties that every law of elasticity must have, written once. All vectors have 3 numbers a
/// vertex.
struct LawUnderTest {
  std::function<double(const Eigen::VectorXd& u)> energy;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& u)> forces;
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& u)> stiffness;
  Eigen::VectorXd rest;  // positions
};

/// Forces are minus the gradient of the energy, by central differences.
inline void expect_forces_are_gradients(const LawUnderTest& law, const Eigen::VectorXd& u,
                                        double step) {
  const Eigen::VectorXd forces = law.forces(u);
  const double scale = forces.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    Eigen::VectorXd forward = u, back = u;
    forward[i] += step;
    back[i] -= step;
    const double slope = (law.energy(forward) - law.energy(back)) / (2 * step);
    EXPECT_NEAR(-slope, forces[i], 2e-7 * scale) << "coordinate " << i;
  }
}

/// Stiffness is minus the derivative of the forces, and symmetric.
inline void expect_stiffness_is_derivative(const LawUnderTest& law, const Eigen::VectorXd& u,
                                           double step) {
  const Eigen::MatrixXd stiffness = law.stiffness(u);
  const double scale = stiffness.cwiseAbs().maxCoeff();
  EXPECT_LE((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(), 1e-12 * scale);
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    Eigen::VectorXd forward = u, back = u;
    forward[i] += step;
    back[i] -= step;
    const Eigen::VectorXd slope = (law.forces(back) - law.forces(forward)) / (2 * step);
    EXPECT_LE((slope - stiffness.col(i)).cwiseAbs().maxCoeff(), 2e-7 * scale) << "column " << i;
  }
}

/// Elastic forces neither push the body as a whole nor, if `turning`, turn it.
inline void expect_momentum(const LawUnderTest& law, const Eigen::VectorXd& u, bool turning) {
  const Eigen::VectorXd forces = law.forces(u);
  const double scale = forces.cwiseAbs().sum();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < u.size(); i += 3) {
    const Eigen::Vector3d f = forces.segment<3>(i);
    const Eigen::Vector3d x = law.rest.segment<3>(i) + u.segment<3>(i);
    force += f;
    torque += x.cross(f);
  }
  EXPECT_LE(force.norm(), 1e-13 * scale);
  if (turning) {
    EXPECT_LE(torque.norm(), 1e-13 * scale * law.rest.cwiseAbs().maxCoeff());
  }
}

/// A turned body has the same energy and turned forces.
inline void expect_objectivity(const LawUnderTest& law, const Eigen::VectorXd& u,
                               const Eigen::Matrix3d& rotation) {
  Eigen::VectorXd turned(u.size());
  Eigen::VectorXd expected = law.forces(u);
  for (Eigen::Index i = 0; i < u.size(); i += 3) {
    const Eigen::Vector3d rest = law.rest.segment<3>(i);
    turned.segment<3>(i) = rotation * (rest + u.segment<3>(i)) - rest;
    expected.segment<3>(i) = (rotation * expected.segment<3>(i)).eval();
  }
  EXPECT_NEAR(law.energy(turned), law.energy(u), 1e-12 * law.energy(u));
  const double scale = expected.cwiseAbs().maxCoeff();
  EXPECT_LE((law.forces(turned) - expected).cwiseAbs().maxCoeff(), 1e-11 * scale);
}

}  // namespace haptrial::test
