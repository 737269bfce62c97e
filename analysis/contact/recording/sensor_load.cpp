#include "analysis/contact/recording/sensor_load.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/contact/recording/block_regression.h"

namespace haptrial::evaluation {
namespace {

constexpr std::size_t kFewest = 40;  // samples without contact

Eigen::Matrix3d crossing(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// R_WS at the times of the forces.
std::vector<Eigen::Matrix3d> sensor_turns(const ContactRecording& recording,
                                          const SensorMount& mount) {
  check(recording.force);
  if (std::abs(mount.orientation.norm() - 1.0) > 1e-6) {
    throw std::invalid_argument("the mount's orientation must have unit length");
  }
  std::vector<Eigen::Matrix3d> turns;
  for (const auto& q : resampled(recording.pose, recording.force.time).orientation) {
    turns.push_back((q * mount.orientation).toRotationMatrix());
  }
  return turns;
}

std::vector<std::size_t> samples_within(const ForceStream& force,
                                        const std::vector<Stretch>& stretches) {
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& s) {
          return s.first <= force.time[i] && force.time[i] <= s.second;
        })) {
      samples.push_back(i);
    }
  }
  if (samples.size() < kFewest) {
    throw std::invalid_argument("stretches without contact must hold 40 samples of force or more");
  }
  return samples;
}

/// The equations of the forces: unknowns are the weight (along `up`, or three) and the offset.
void fit_forces(const ForceStream& force, const std::vector<Eigen::Matrix3d>& turns,
                const std::vector<std::size_t>& samples, const std::optional<Eigen::Vector3d>& up,
                LoadFit& fit) {
  const Eigen::Index weights = up ? 1 : 3;
  const auto rows = static_cast<Eigen::Index>(3 * samples.size());
  Eigen::MatrixXd x(rows, weights + 3);
  Eigen::VectorXd y(rows);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * k);
    const Eigen::Matrix3d to_sensor = turns[samples[k]].transpose();
    if (up) {
      x.block<3, 1>(row, 0) = -to_sensor * up->normalized();
    } else {
      x.block<3, 3>(row, 0) = to_sensor;
    }
    x.block<3, 3>(row, weights).setIdentity();
    y.segment<3>(row) = force.force[samples[k]];
  }
  std::vector<std::string> names{"weight"};
  if (!up) {
    names = {"weight x", "weight y", "weight z"};
  }
  names.insert(names.end(), {"offset x", "offset y", "offset z"});
  const BlockFit found = fit_blocks(x, y, names, {10, 0.95});
  fit.load.weight = up ? Eigen::Vector3d(-found.coefficients[0] * up->normalized())
                       : Eigen::Vector3d(found.coefficients.head<3>());
  fit.load.force_offset = found.coefficients.tail<3>();
  fit.force_rms = found.residual_rms;
  fit.unfixed = found.confounded;
}

void fit_torques(const ForceStream& force, const std::vector<Eigen::Matrix3d>& turns,
                 const std::vector<std::size_t>& samples, LoadFit& fit) {
  const auto rows = static_cast<Eigen::Index>(3 * samples.size());
  Eigen::MatrixXd x(rows, 6);
  Eigen::VectorXd y(rows);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * k);
    const Eigen::Vector3d weight = turns[samples[k]].transpose() * fit.load.weight;
    x.block<3, 3>(row, 0) = -crossing(weight);  // c x w = -w x c
    x.block<3, 3>(row, 3).setIdentity();
    y.segment<3>(row) = force.torque[samples[k]];
  }
  const BlockFit found = fit_blocks(
      x, y, {"centre x", "centre y", "centre z", "torque x", "torque y", "torque z"}, {10, 0.95});
  fit.load.centre = found.coefficients.head<3>();
  fit.load.torque_offset = found.coefficients.tail<3>();
  fit.unfixed.insert(fit.unfixed.end(), found.confounded.begin(), found.confounded.end());
}

}  // namespace

LoadFit estimate_load(const ContactRecording& recording, const SensorMount& mount,
                      const std::vector<Stretch>& free, const std::optional<Eigen::Vector3d>& up) {
  if (up && !(up->norm() > 0.0 && up->allFinite())) {
    throw std::invalid_argument("up must have a length above 0");
  }
  const std::vector<Eigen::Matrix3d> turns = sensor_turns(recording, mount);
  const std::vector<std::size_t> samples = samples_within(recording.force, free);
  LoadFit fit;
  fit_forces(recording.force, turns, samples, up, fit);
  if (!recording.force.torque.empty()) {
    fit_torques(recording.force, turns, samples, fit);
  }
  return fit;
}

ForceStream contact_forces(const ContactRecording& recording, const SensorMount& mount,
                           const SensorLoad& load) {
  const std::vector<Eigen::Matrix3d> turns = sensor_turns(recording, mount);
  ForceStream result{recording.force.time, {}, {}};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    result.force.emplace_back(turns[i] * (recording.force.force[i] - load.force_offset) -
                              load.weight);
    if (!recording.force.torque.empty()) {
      const Eigen::Vector3d moment = load.centre.cross(turns[i].transpose() * load.weight);
      result.torque.emplace_back(turns[i] *
                                 (recording.force.torque[i] - load.torque_offset - moment));
    }
  }
  return result;
}

}  // namespace haptrial::evaluation
