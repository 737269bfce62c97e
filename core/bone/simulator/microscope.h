#pragma once

#include "core/base/camera.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::bone {

/// How buttons and the hand steer it. Source: Morris 2006, §8.2.2: while one button is held the
/// hand's motion moves the view, while another is held it turns it, and nothing else moves.
struct MicroscopeParameters {
  Camera start{.eye = {0.0, 0.18, 0.09}};
  double move_gain{1.0};   // distance of the view for a distance of the hand >= 0
  double turn_gain{12.0};  // angle for a distance of the hand >= 0 [rad/m]
  double zoom_rate{1.0};   // how fast a held button zooms: e-folds a second >= 0 [1/s]
  double narrowest{0.02};  // field of view > 0 [rad]
  double widest{1.5};      // >= narrowest, < pi [rad]
};

/// The keys of [camera].
const Schema<MicroscopeParameters>& microscope_schema();

/// Eye and target go along with the hand, as if it held the microscope.
/// @param motion  of the hand as the picture sees it: right, up, towards the eye [m]
Camera moved(const Camera& from, const Eigen::Vector3d& motion) noexcept;
/// The eye goes around the target; near the poles it stops. @param right, above  [rad]
Camera turned(const Camera& from, double right, double above) noexcept;
/// Things become `factor` > 0 times as large, within the bounds.
Camera zoomed(const Camera& from, double factor, const MicroscopeParameters& bounds) noexcept;

}  // namespace haptrial::bone
