#include "core/contact/face_end.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace haptrial::contact {

using Eigen::Vector3d;

double face_end(const geometry::Corners& c, const Vector3d& normal, const Vector3d& from,
                const Vector3d& move, double beyond) noexcept {
  double part = 1.0;
  for (int k = 0; k < 3; ++k) {
    const Vector3d edge = c[(k + 1) % 3] - c[k];
    Vector3d out = edge.cross(normal);
    if (out.dot(c[(k + 2) % 3] - c[k]) > 0.0) {
      out = -out;
    }
    const double left = beyond * out.norm() - out.dot(from - c[k]);
    const double rate = out.dot(move);
    if (left <= 0.0) {
      return 1.0;
    }
    if (rate * part > left) {
      part = left / rate;
    }
  }
  return part;
}

}  // namespace haptrial::contact
