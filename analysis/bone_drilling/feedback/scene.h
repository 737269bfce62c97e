#pragma once

#include <Eigen/Core>
#include <string>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::analysis::drilling {

/// Direction from which a procedure was looked at first, in W.
struct FirstView {
  Eigen::Vector3d towards_eye{Eigen::Vector3d::UnitZ()};  // any length but 0
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};           // in the picture, not along it
};

/// A bone after a procedure as a JSON object for view.html: its surface, vital structures, removals
/// with what was wrong with them and what the plan says of them, planned bone that is left, paths
/// of strokes, all in W as 16-bit numbers in base64. No
/// character of it ends a script.
std::string scene_json(const Findings& findings, const FirstView& view);

}  // namespace haptrial::analysis::drilling
