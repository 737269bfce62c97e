// Motions by CVODE held against an exact vibration and against Verlet's method.

#include "core/deformable/body/reference_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/deformable/elements/elastic_body.h"
#include "core/deformable/springs/spring_motion.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

class ReferenceMotionTest : public testing::Test {
 protected:
  ReferenceMotionTest()
      : body_(test::solid_block({1, 1, 2}, 0.01),
              Elasticity{{{2e3, 0.3, 1000}}, {}, Law::kLinear}) {
    problem_.masses.assign(body_.masses().begin(), body_.masses().end());
    const std::size_t n = problem_.masses.size();
    problem_.held.assign(n, 0);
    std::fill_n(problem_.held.begin(), kHeld, std::uint8_t{1});
    problem_.start.assign(n, Vector3d::Zero());
    problem_.load.assign(n, Vector3d::Zero());
    problem_.elastic = [this](const Vectors& u, Vectors& f) {
      return std::isfinite(body_.forces(u, f));
    };
    damp(kAlpha);
  }
  void damp(double alpha) {
    problem_.drag.clear();
    for (const double m : problem_.masses) {
      problem_.drag.push_back(alpha * m);
    }
  }

  /// The n-th mode of the free vertices, largest coordinate 1 mm; its frequency [rad/s].
  std::pair<Vectors, double> mode(Eigen::Index number) const {
    const auto n = static_cast<Eigen::Index>(problem_.masses.size());
    const Eigen::Index held = 3 * kHeld, free = 3 * n - held;
    MatrixXd stiffness(free, free);
    VectorXd masses(free);
    Vectors u(problem_.masses.size(), Vector3d::Zero()), f;
    for (Eigen::Index i = 0; i < free; ++i) {
      const auto v = static_cast<std::size_t>((held + i) / 3);
      u[v][(held + i) % 3] = 1.0;
      body_.forces(u, f);
      u[v].setZero();
      stiffness.col(i) = -Eigen::Map<const VectorXd>(f[0].data(), 3 * n).tail(free);
      masses[i] = problem_.masses[v];
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(
        stiffness, masses.asDiagonal().toDenseMatrix());
    const VectorXd shape = modes.eigenvectors().col(number);
    Vectors result(problem_.masses.size(), Vector3d::Zero());
    for (Eigen::Index i = 0; i < free; ++i) {
      result[static_cast<std::size_t>((held + i) / 3)][(held + i) % 3] =
          1e-3 * shape[i] / shape.cwiseAbs().maxCoeff();
    }
    return {result, std::sqrt(modes.eigenvalues()[number])};
  }

  static constexpr Eigen::Index kHeld = 4;  // the lowest layer of vertices
  static constexpr double kAlpha = 8.0;     // [1/s]
  ElasticBody body_;
  MotionProblem problem_;
};

/// u = shape exp(-a t / 2) (cos w' t + a / 2w' sin w' t), w'² = w² - a² / 4.
TEST_F(ReferenceMotionTest, ADampedModeIsTheExactOne) {
  for (const Eigen::Index number : {0, 9}) {
    const auto [shape, frequency] = mode(number);
    problem_.start = shape;
    const std::array times{0.05, 0.1, 0.2};
    const auto motion = reference_motion(problem_, times, {1e-9, 1e-3});
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double damped = std::sqrt(frequency * frequency - 0.25 * kAlpha * kAlpha);
      const double share =
          std::exp(-0.5 * kAlpha * times[i]) *
          (std::cos(damped * times[i]) + 0.5 * kAlpha / damped * std::sin(damped * times[i]));
      Vectors exact = shape;
      for (Vector3d& u : exact) {
        u *= share;
      }
      EXPECT_LT(motion_distance({&motion[i], 1}, {&exact, 1}), 1e-6 * 1e-3) << number << " " << i;
    }
  }
}

/// Springs by Verlet's method begin with a whole kick, half a step too early: their error falls with
/// the step, and two steps extrapolate to the truth.
TEST_F(ReferenceMotionTest, VerletConvergesToIt) {
  SpringBody springs =
      spring_body(test::solid_block({1, 1, 2}, 0.01), 1000.0, UniformConstants{1e-3, 1e-3, 1e-3});
  constexpr double kDrag = 2e-4, kTime = 0.05;
  problem_.masses = springs.masses;
  problem_.drag.assign(springs.masses.size(), kDrag);
  problem_.load.back() = {2e-3, 1e-3, 0.0};
  problem_.elastic = [&](const Vectors& u, Vectors& f) {
    Vectors x = springs.rest;
    for (std::size_t v = 0; v < x.size(); ++v) {
      x[v] += u[v];
    }
    f = spring_forces(springs, x);
    return true;
  };
  const Vectors truth = reference_motion(problem_, std::array{kTime}, {1e-10, 1e-3})[0];
  ASSERT_GT(truth.back().norm(), 1e-4);
  const auto by_verlet = [&](double step) {
    SpringMotion verlet(springs, {.step = step, .damping = kDrag}, std::array{0, 1, 2, 3});
    verlet.set_force(springs.rest.size() - 1, problem_.load.back());
    while (verlet.time() < kTime - 0.5 * step) {
      verlet.step();
    }
    Vectors u = verlet.positions();
    for (std::size_t v = 0; v < u.size(); ++v) {
      u[v] -= springs.rest[v];
    }
    return u;
  };
  const auto off = [&](const Vectors& u) { return motion_distance({&u, 1}, {&truth, 1}); };
  const Vectors coarse = by_verlet(1e-4), fine = by_verlet(5e-5);
  Vectors extrapolated = fine;
  for (std::size_t v = 0; v < fine.size(); ++v) {
    extrapolated[v] = 2.0 * fine[v] - coarse[v];
  }
  EXPECT_GT(off(coarse) / off(fine), 1.8);
  EXPECT_LT(off(coarse) / off(fine), 2.2);
  EXPECT_LT(off(extrapolated), 0.1 * off(fine));
}

TEST_F(ReferenceMotionTest, DampingIsFoundFromTheMotion) {
  problem_.load.back() = {2e-3, 1e-3, 0.0};
  const std::array times{0.02, 0.05, 0.1, 0.15};
  const auto recorded = reference_motion(problem_, times);
  const double found = fitted_damping(recorded, 0.1, 1000.0, [&](double alpha) {
    damp(alpha);
    return reference_motion(problem_, times);
  });
  EXPECT_NEAR(found, kAlpha, 0.01 * kAlpha);
}

TEST_F(ReferenceMotionTest, AForceThatIsNotDefinedEndsWithASentence) {
  problem_.load.back() = {2e-3, 0.0, 0.0};
  problem_.elastic = [&](const Vectors& u, Vectors& f) {
    f.assign(u.size(), Vector3d::Zero());
    return u.back().x() < 1e-4;
  };
  EXPECT_NE(test::message_of([&] {
              reference_motion(problem_, std::array{1.0});
            }).find("the motion cannot be followed beyond"),
            std::string::npos);
}

}  // namespace
}  // namespace haptrial::deformable
