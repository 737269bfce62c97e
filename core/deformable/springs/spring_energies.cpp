#include "core/deformable/springs/spring_energies.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

double half_square(const Spring& spring, double measure) {
  const double strain = (measure - spring.rest) / spring.rest;
  return 0.5 * spring.constant * strain * strain;
}

/// dE/dm for the measure m.
double slope(const Spring& spring, double measure) {
  return spring.constant * (measure - spring.rest) / (spring.rest * spring.rest);
}

/// |dA/dx| of each corner of an equilateral triangle of this area: half its edge.
double regular_area_gradient(double area) {
  return 0.5 * std::sqrt(4.0 * area / std::numbers::sqrt3);
}

/// |dV/dx| of each corner of a regular tetrahedron of this volume: a third of its face.
double regular_volume_gradient(double volume) {
  const double edge = std::cbrt(6.0 * std::numbers::sqrt2 * volume);
  return std::numbers::sqrt3 / 12.0 * edge * edge;
}

/// -slope · gradient, with gradients of length `unit` each in the printed form.
template <class Points>
Points pulled(const Points& gradient, double slope, ForceForm form, double unit) {
  Points forces;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const double size = gradient[i].norm();
    const double scale = form == ForceForm::kPrinted ? (size > 0 ? unit / size : 0.0) : 1.0;
    forces[i] = (-slope * scale) * gradient[i];
  }
  return forces;
}

}  // namespace

double length_energy(const Spring& spring, const Points2& points) {
  return half_square(spring, (points[1] - points[0]).norm());
}

double area_energy(const Spring& spring, const Points3& points) {
  return half_square(spring, area_of(points));
}

double volume_energy(const Spring& spring, const Points4& points) {
  return half_square(spring, volume_of(points));
}

Points2 length_forces(const Spring& spring, const Points2& points) {
  const Vector3d along = points[1] - points[0];
  const double length = along.norm();
  if (length == 0) {
    return {Vector3d::Zero(), Vector3d::Zero()};
  }
  const Vector3d force = (slope(spring, length) / length) * along;
  return {force, -force};
}

Points3 area_forces(const Spring& spring, const Points3& points, ForceForm form) {
  return pulled(area_gradient(points), slope(spring, area_of(points)), form,
                regular_area_gradient(spring.rest));
}

Points4 volume_forces(const Spring& spring, const Points4& points, ForceForm form) {
  return pulled(volume_gradient(points), slope(spring, volume_of(points)), form,
                regular_volume_gradient(spring.rest));
}

double area_of(const Points3& p) { return 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm(); }

Points3 area_gradient(const Points3& p) {
  const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double size = normal.norm();
  if (size == 0) {
    return {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  }
  const Vector3d unit = normal / size;
  const Vector3d at1 = 0.5 * (p[2] - p[0]).cross(unit);
  const Vector3d at2 = 0.5 * unit.cross(p[1] - p[0]);
  return {-(at1 + at2), at1, at2};
}

double volume_of(const Points4& p) {
  return (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) / 6.0;
}

Points4 volume_gradient(const Points4& p) {
  const Vector3d a = p[1] - p[0];
  const Vector3d b = p[2] - p[0];
  const Vector3d c = p[3] - p[0];
  const Vector3d at1 = b.cross(c) / 6.0;
  const Vector3d at2 = c.cross(a) / 6.0;
  const Vector3d at3 = a.cross(b) / 6.0;
  return {-(at1 + at2 + at3), at1, at2, at3};
}

}  // namespace haptrial::deformable
