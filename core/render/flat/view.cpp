#include "core/render/flat/view.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace haptrial::render {

View fit(const Rectangle& world, const Rectangle& screen) {
  double scale = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    if (!(screen.size()[axis] > 0.0)) {
      throw std::invalid_argument("a view needs a part of the screen with both sides above zero");
    }
    if (world.size()[axis] > 0.0) {
      scale = std::min(scale, screen.size()[axis] / world.size()[axis]);
    }
  }
  if (!(scale < std::numeric_limits<double>::infinity())) {
    throw std::invalid_argument("a view needs a part of the world with a finite side above zero");
  }
  return {scale, world.centre(), screen.centre()};
}

}  // namespace haptrial::render
