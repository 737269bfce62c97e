// The guide, the device and the hand as one sampled loop: eigenvalues say where it is stable, and
// the simulation has to agree.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/control/pd_controller.h"
#include "core/device/virtual_device.h"
#include "core/subject/hand.h"
#include "protocols/force_training/force_definition.h"
#include "tests/experiments/shipped.h"

namespace haptrial {
namespace {

class StabilityTest : public testing::Test {
 protected:
  StabilityTest() {
    definition_.hand.coulomb_friction = 0.0;
    definition_.device.position_quantum = 0.0;
    definition_.device.max_force = 1e300;  // the loop without its limits
  }

  /// Largest modulus of the eigenvalues of one axis in closed loop. The state is what the physics,
  /// the delayed force and the velocity estimate remember: hand (5), pending force, n past
  /// positions.
  double spectral_radius(const control::PdGains& gains) const {
    const double dt = 1.0 / definition_.rate;
    const auto dynamics = subject::axis_dynamics(definition_.hand, true);
    Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(7, 7);
    augmented.topLeftCorner(5, 5) = dynamics.system * dt;
    augmented.topRightCorner(5, 2) = dynamics.input * dt;
    const Eigen::MatrixXd flow = augmented.exp();

    const int n = definition_.device.velocity_window;
    const int size = 6 + n;
    Eigen::RowVectorXd force =
        Eigen::RowVectorXd::Zero(size);  // of the state: newest position first
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      const double centred = 0.5 * (n - 1) - i;
      sum += centred * centred;
    }
    for (int i = 0; i < n; ++i) {
      force[6 + i] -= gains.damping * (0.5 * (n - 1) - i) / (sum * dt);
    }
    force[6] -= gains.stiffness;

    Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(size, size);
    loop.topLeftCorner(5, 5) = flow.topLeftCorner(5, 5);
    loop.block(0, 5, 5, 1) = flow.block(0, 5, 5, 1);
    loop.row(5) = force;        // commanded now, acts in the next step
    loop.row(6) = loop.row(0);  // the position after this step is the newest reading
    for (int i = 1; i < n; ++i) {
      loop(6 + i, 6 + i - 1) = 1.0;
    }
    return Eigen::EigenSolver<Eigen::MatrixXd>(loop, false).eigenvalues().cwiseAbs().maxCoeff();
  }

  /// Root mean square of x over the last second of ten, over that of the first, after a knock.
  double growth(const control::PdGains& gains) const {
    subject::Hand hand(definition_.hand, 1.0 / definition_.rate, Eigen::Vector3d::Zero());
    device::VirtualDevice device(definition_.device, hand, definition_.rate);
    const control::PdController controller(gains);
    const int ticks = static_cast<int>(10.0 * definition_.rate);
    const int second = static_cast<int>(definition_.rate);
    double first = 0.0;
    double last = 0.0;
    device::DeviceReading reading;
    for (int tick = 0; tick < ticks; ++tick) {
      device.read(reading);
      Eigen::Vector3d force = controller.force({}, reading.tool);
      force.x() += tick < 20 ? 1.0 : 0.0;
      device.write(force);
      const double x2 = hand.state().position.x() * hand.state().position.x();
      first += tick < second ? x2 : 0.0;
      last += tick >= ticks - second ? x2 : 0.0;
    }
    return std::sqrt(last / first);
  }

  /// The stiffness above which the loop without damping is unstable.
  double stiffness_bound() const {
    double low = 0.0;
    double high = 1e6;
    while (high - low > 1.0) {
      const double middle = 0.5 * (low + high);
      (spectral_radius({middle, 0.0}) < 1.0 ? low : high) = middle;
    }
    return low;
  }

  protocols::ForceDefinition definition_ =
      protocols::load_force_definition(test::shipped_definition());
};

TEST_F(StabilityTest, PublishedGainsAreStable) {
  for (const control::PdGains& gains :
       {definition_.guidance.trajectory, definition_.guidance.plane}) {
    EXPECT_LT(spectral_radius(gains), 1.0) << gains.stiffness;
    EXPECT_LT(growth(gains), 1e-2) << gains.stiffness;
  }
}

TEST_F(StabilityTest, WithoutDampingTheBoundIsThatOfTheSampledLoop) {
  // A delay of one and a half samples takes k · 1.5 T of damping away (Colgate and Schenkel 1997);
  // what the hand's damping and posture give sets the bound.
  const double bound = stiffness_bound();
  RecordProperty("stiffness_bound_N_per_m", std::to_string(bound));
  const subject::HandParameters& hand = definition_.hand;
  const double available = hand.damping + hand.stiffness * hand.posture_time;
  EXPECT_GT(bound, hand.damping / (1.5 / definition_.rate) * 0.9);
  EXPECT_LT(bound, available / (1.5 / definition_.rate));
}

TEST_F(StabilityTest, SimulationAgreesWithTheEigenvaluesOnBothSidesOfTheBound) {
  const double bound = stiffness_bound();
  EXPECT_LT(growth({0.8 * bound, 0.0}), 0.5);
  EXPECT_GT(growth({1.25 * bound, 0.0}), 10.0);
}

TEST_F(StabilityTest, TooMuchDampingIsUnstableToo) {
  // The velocity estimate is late: damping that is too high feeds energy in.
  double low = 0.0;
  double high = 1e4;
  while (high - low > 1.0) {
    const double middle = 0.5 * (low + high);
    (spectral_radius({2000.0, middle}) < 1.0 ? low : high) = middle;
  }
  EXPECT_GT(low, 300.0) << "the published damping of the plane is inside";
  EXPECT_GT(growth({2000.0, 1.05 * high}), 10.0) << high;
}

}  // namespace
}  // namespace haptrial
