#include "core/geometry/bvh/flat_triangle.h"

namespace haptrial::geometry {

void leave_empty(Leaf& leaf, int place) {
  for (auto& row : leaf.row) {
    for (auto& values : row) {
      values[place] = 0.0f;
    }
  }
  leaf.row[2][3][place] = 1e30f;  // its square is infinite
  for (int side = 0; side < 2; ++side) {
    leaf.leg[side][place] = leaf.length[side][place] = leaf.dy[side][place] = 0.0f;
    leaf.dx[side][place] = 1.0f;
  }
}

}  // namespace haptrial::geometry
