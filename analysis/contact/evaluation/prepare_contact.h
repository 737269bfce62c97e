#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/evaluation/contact_samples.h"
#include "analysis/contact/evaluation/registration.h"
#include "analysis/contact/recording/sensor_load.h"
#include "analysis/contact/recording/stream_lag.h"
#include "core/contact/felt_body.h"

namespace haptrial::evaluation {

struct PrepareOptions {
  SensorMount mount{};                           // of the force sensor on the probe
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};  // p_PT: the probe's point, or its sphere's centre
  double radius{0.0};                            // of the probe's sphere >= 0 [m]
  bool force_on_body{false};                     // the sensor says what acts on the body
  std::vector<Stretch> free{};                   // without contact; none: no load is removed
  std::optional<Eigen::Vector3d> up{};           // against gravity in W, if known
  std::optional<SensorLoad> load{};              // known: `free` is not needed
  std::optional<double> lag{};                   // of the force's clock [s]; default: estimated
  bool registered{false};                        // poses are in the mesh's frame already
  RegistrationOptions registration{};            // its radius is replaced by the probe's
  double rate{1000.0};                           // of the rendering, 10 to 1e5 [Hz]
  double stiffness{1000.0};                      // k of the in-trajectory > 0 [N/m]
  double smoothing{0.002};                       // of normals along the path >= 0 [m]
  double crease_angle{0.5};                      // sharper edges keep their normals [rad]
  double least_force{0.2};                       // of a contact > 0 [N]
  bool onto_surface{true};                       // contacts are moved to the nearest of the mesh
};

/// A recording brought to one clock and to the mesh's frame.
struct PreparedContact {
  std::optional<LagFit> lag;    // estimated
  double lag_used{0.0};         // [s]
  double friction_by_lag{0.0};  // half of an interval: friction that the lag leaves open
  bool lag_like_friction{false};
  std::optional<LoadFit> load;  // estimated
  std::optional<Registration> registration;
  double least_force{0.0};              // of a contact [N]
  double rate{0.0};                     // [Hz]
  double stiffness{0.0};                // [N/m]
  double contact_share{0.0};            // of the samples
  std::vector<double> time;             // (n) [s]
  std::vector<bool> touching;           // (n) the normal force is above `least_force`
  std::vector<Eigen::Vector3d> out;     // (n) contact on the surface; the probe in the air [m]
  std::vector<Eigen::Vector3d> in;      // (n) for a point tool [m]
  std::vector<Eigen::Vector3d> normal;  // (n)
  std::vector<Eigen::Vector3d> force;   // (n) on the probe [N]
  ContactSamples samples;               // at the poses' own times
  double velocity_noise{0.0};           // of these [m/s]
  std::vector<std::string> remarks;     // sentences about what is doubtful
};

/// The steps before a rendering: sensor load and lag removed, path registered, in-trajectory.
///
/// A contact's place is noisy by more than its force bends a surface: pose noise of 0.5 mm times
/// 1000 N/m is 0.5 N. With `onto_surface` contacts are therefore the nearest points of the mesh, as
/// the source's out-trajectory never enters the object; what they were moved by is the
/// registration's residual. In the air only points that noise put inside are moved.
/// @throws std::invalid_argument for an option that breaks its bound, streams that do not overlap
/// or fewer than 12 contacts. Source: Morris 2006, §7.2 to §7.3.1.
PreparedContact prepare_contact(const ContactRecording& recording, const contact::FeltBody& body,
                                const PrepareOptions& options);

}  // namespace haptrial::evaluation
