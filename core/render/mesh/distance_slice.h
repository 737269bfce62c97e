#pragma once

#include <span>

#include "core/render/gl/image.h"

namespace haptrial::render {

/// Signed distances on a plane, sampled on a square grid.
struct DistanceSlice {
  std::span<const double> values;  // (rows x columns) [m], rows from the bottom; NaN: none
  int columns{0};
  int rows{0};
  double spacing{1.0};  // between samples [m]
};

/// A picture with `size` pixels along its longer side: blue inside (below 0), orange outside, paler
/// with every tenth of the largest distance, thin lines between; a dark line where the distance is
/// 0; white where there is no number. Values between samples are linear.
/// @throws std::invalid_argument where the values are not rows x columns, or size < 1.
Image draw_distances(const DistanceSlice& slice, int size);

}  // namespace haptrial::render
