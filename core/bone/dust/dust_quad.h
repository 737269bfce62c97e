#pragma once

#include <Eigen/Core>

namespace haptrial::bone {

/// A cell of dust to draw as a few grains.
struct DustQuad {
  Eigen::Vector3f position{Eigen::Vector3f::Zero()};  // of its middle, in W [m]
  float size{0.0005F};                                // of the cell [m]
  float alpha{0.5F};                                  // from 0 to 1
};

}  // namespace haptrial::bone
