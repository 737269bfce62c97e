#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/contact/recording/streams.h"

namespace haptrial::evaluation {

/// How the force sensor S sits on the probe P.
struct SensorMount {
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // R_PS, unit length
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};               // p_PS [m]
};

/// Reading of the sensor without contact:
///
///     F_S = R_WSᵀ w_W + b_S,   T_S = c_S x R_WSᵀ w_W + t_S
///
/// w is the weight of all that hangs on the sensor, c its centre, b and t are offsets.
struct SensorLoad {
  Eigen::Vector3d weight{Eigen::Vector3d::Zero()};         // w_W [N]
  Eigen::Vector3d force_offset{Eigen::Vector3d::Zero()};   // b_S [N]
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};         // c_S [m]
  Eigen::Vector3d torque_offset{Eigen::Vector3d::Zero()};  // t_S [N·m]
};

struct LoadFit {
  SensorLoad load;
  double force_rms{0.0};             // left without contact, each component [N]
  std::vector<std::string> unfixed;  // sentences: what the orientations do not tell apart
};

using Stretch = std::pair<double, double>;  // from, to [s]

/// The load by least squares over samples in the stretches, where the probe touches nothing.
/// @param up  direction against gravity in W, if known: then the weight has one unknown, else three
/// @throws std::invalid_argument for bad streams, a bad mount, `up` of no length, or when the
/// stretches hold fewer than 40 samples.
LoadFit estimate_load(const ContactRecording& recording, const SensorMount& mount,
                      const std::vector<Stretch>& free,
                      const std::optional<Eigen::Vector3d>& up = std::nullopt);

/// The contact's forces alone, in W, and its torques in W about the sensor's origin: what acts on
/// the probe. Orientations are those of the recording at each force's time.
ForceStream contact_forces(const ContactRecording& recording, const SensorMount& mount,
                           const SensorLoad& load);

}  // namespace haptrial::evaluation
