#include "core/bone/simulator/burr_tool.h"

namespace haptrial::bone {

ShaftParameters default_shaft(double radius, double length) {
  ShaftParameters shaft;
  shaft.radius = radius;
  shaft.length = length;
  shaft.feel = default_feel(BurrShape(shaft.dimensions()).ball_radius());
  return shaft;
}

}  // namespace haptrial::bone
