#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/deformable/body/reference_motion.h"
#include "core/deformable/springs/spring_body.h"
#include "experiments/command/deform/deform_body.h"

namespace haptrial::experiments {

struct RecordedMotionOptions {
  double seconds{};    // duration [s]
  int frames{};        // over the duration
  double damping{};    // by mass, of the elements [1/s]
  double tolerance{};  // relative, of CVODE
};

/// Springs that move as a reference does.
struct SpringsInMotion {
  double damping{};   // by mass, with which they come nearest [1/s]
  double distance{};  // root mean square over vertices and frames with it [m]
  double same{};      // with the damping of the elements [m]
};

/// A body from rest on under a constant load: the motion of its elements by CVODE.
struct RecordedMotion {
  std::vector<double> times;                      // [s]
  std::vector<deformable::Vectors> displacement;  // by time
  double moved{};                                 // root mean square [m]
  std::optional<SpringsInMotion> springs;
};

/// @param springs  whose damping is calibrated against the motion; null: none
/// @throws InputError as reference_motion().
RecordedMotion recorded_motion(const deformable::ElasticBody& elastic,
                               const deformable::LoadCase& load,
                               const deformable::SpringBody* springs,
                               const RecordedMotionOptions& options);

/// A row for each frame and vertex: time_s, vertex, ux_m, uy_m, uz_m.
std::string motion_csv(const RecordedMotion& motion);

}  // namespace haptrial::experiments
