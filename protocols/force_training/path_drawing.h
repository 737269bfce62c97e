#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/render/flat/trial_display_style.h"
#include "protocols/interface/drawing.h"

namespace haptrial::protocols {

/// A path with the tool on it, bars and marks: draws stimulus::Presentation.
/// @param points  of the path, p_W (N x 3) [m]
MakeDrawing path_drawing(const render::TrialDisplayStyle& style,
                         std::vector<Eigen::Vector3d> points);

}  // namespace haptrial::protocols
