#include "core/geometry/mesh/ray_crossing.h"

#include <cmath>
#include <utility>

namespace haptrial::geometry {
namespace {

struct Flat {
  double x, y;
};

/// a.x b.y - a.y b.x with the right sign, and zero only where it is zero (Kahan's difference of
/// products; Jeannerod et al. 2013).
double determinant(const Flat& a, const Flat& b) {
  const double first = a.x * b.y, second = a.y * b.x;
  const double difference = first - second;
  if (std::abs(difference) > 1e-15 * (std::abs(first) + std::abs(second))) {
    return difference;
  }
  const double lost = std::fma(-a.y, b.x, second);
  return std::fma(a.x, b.y, -second) + lost;
}

/// Side of the edge from a to b on which the origin lies: 1 left, -1 right, 0 if a and b coincide.
int side_of(double determinant, const Flat& a, const Flat& b) {
  if (determinant != 0.0) {
    return determinant > 0.0 ? 1 : -1;
  }
  if (a.y != b.y) {
    return a.y > b.y ? 1 : -1;
  }
  if (a.x != b.x) {
    return b.x > a.x ? 1 : -1;
  }
  return 0;
}

}  // namespace

RayCrossing::RayCrossing(const Ray& ray) : origin_(ray.origin) {
  ray.direction.cwiseAbs().maxCoeff(&z_);
  x_ = (z_ + 1) % 3;
  y_ = (z_ + 2) % 3;
  if (ray.direction[z_] < 0.0) {
    std::swap(x_, y_);
  }  // keeps left and right
  shear_x_ = ray.direction[x_] / ray.direction[z_];
  shear_y_ = ray.direction[y_] / ray.direction[z_];
  scale_z_ = 1.0 / ray.direction[z_];
}

std::optional<RayCrossing::Crossing> RayCrossing::operator()(const Corners& corners) const {
  Flat flat[3];
  double depth[3];
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d from = corners[i] - origin_;
    flat[i] = {from[x_] - shear_x_ * from[z_], from[y_] - shear_y_ * from[z_]};
    depth[i] = from[z_] * scale_z_;
  }
  const double w0 = determinant(flat[1], flat[2]);
  const double w1 = determinant(flat[2], flat[0]);
  const double w2 = determinant(flat[0], flat[1]);
  const int side = side_of(w0, flat[1], flat[2]);
  if (side == 0 || side_of(w1, flat[2], flat[0]) != side || side_of(w2, flat[0], flat[1]) != side) {
    return std::nullopt;
  }
  const double sum = w0 + w1 + w2;
  if (sum == 0.0) {
    return std::nullopt;
  }
  return Crossing{(w0 * depth[0] + w1 * depth[1] + w2 * depth[2]) / sum, side < 0};
}

}  // namespace haptrial::geometry
