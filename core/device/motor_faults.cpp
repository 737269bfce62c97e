#include "core/device/motor_faults.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/schema.h"

namespace haptrial::device {

const Schema<MotorFaults>& motor_faults_schema() {
  using F = MotorFaults;
  static const auto schema =
      Schema<F>()
          .number("gain", &F::gain, {0.0, 10.0, true}, "1",
                  "Force that the virtual device's motors give per force commanded")
          .number("dead_zone", &F::dead_zone, {0.0, 10.0}, "N",
                  "Length of a commanded force up to which the virtual device gives none; a longer "
                  "one is shortened by it")
          .number("resonance", &F::resonance, {0.0, 5000.0}, "Hz",
                  "Resonance of the virtual device's transmission; 0: it is rigid")
          .number("resonance_damping", &F::resonance_damping, {0.001, 2.0}, "1",
                  "Damping of that resonance, as a share of critical damping")
          .number("cogging", &F::cogging, {0.0, 10.0}, "N",
                  "Amplitude of the virtual device's cogging, a force along each axis that "
                  "alternates with the position along it")
          .number("cogging_period", &F::cogging_period, {1e-4, 0.1}, "m",
                  "Way over which the cogging repeats itself")
          .number("gravity_error", &F::gravity_error, {-10.0, 10.0}, "N",
                  "Upward force that the virtual device's gravity compensation leaves")
          .number("sensor_noise", &F::sensor_noise, {0.0, 1.0}, "N",
                  "Standard deviation of the simulated force sensor with which device-test makes a "
                  "certificate of the virtual device");
  return schema;
}

Eigen::Matrix2d resonator_step(double resonance, double damping, double period) {
  using Complex = std::complex<double>;
  const double w = 2.0 * std::numbers::pi * resonance;
  const double z = damping;
  Complex root = w * std::sqrt(Complex(z * z - 1.0));
  if (std::abs(root) < 1e-9 * w) {
    root = 1e-9 * w;  // critical damping is the limit
  }
  const double decay = std::exp(-z * w * period);
  const double c = decay * std::cosh(root * period).real();
  const double s = decay * (std::sinh(root * period) / root).real();
  Eigen::Matrix2d step;
  step << c + z * w * s, s, -w * w * s, c - z * w * s;
  return step;
}

FaultyMotors::FaultyMotors(const MotorFaults& faults, double period) : faults_(faults) {
  if (!(faults.gain > 0.0 && faults.dead_zone >= 0.0 && faults.resonance >= 0.0 &&
        faults.resonance_damping > 0.0 && faults.cogging_period > 0.0 && period > 0.0 &&
        std::isfinite(faults.cogging) && std::isfinite(faults.gravity_error))) {
    throw std::invalid_argument(
        "FaultyMotors: gain, resonance_damping, cogging_period and the period must be above 0, "
        "dead_zone and resonance at least 0, cogging and gravity_error finite");
  }
  if (faults.resonance > 0.0) {
    step_ = resonator_step(faults.resonance, faults.resonance_damping, period);
  }
}

Eigen::Vector3d FaultyMotors::force(const Eigen::Vector3d& command,
                                    const Eigen::Vector3d& position) noexcept {
  const double length = command.norm();
  Eigen::Vector3d given = Eigen::Vector3d::Zero();
  if (length > faults_.dead_zone) {
    given = faults_.gain * (1.0 - faults_.dead_zone / length) * command;
  }
  if (faults_.resonance > 0.0) {
    state_.row(0) -= given.transpose();
    state_ = (step_ * state_).eval();
    state_.row(0) += given.transpose();
    given = state_.row(0);
  }
  if (faults_.cogging != 0.0) {
    const double turn = 2.0 * std::numbers::pi / faults_.cogging_period;
    given -= faults_.cogging * (turn * position).array().sin().matrix();
  }
  given.y() += faults_.gravity_error;
  return given;
}

}  // namespace haptrial::device
