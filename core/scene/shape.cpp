#include "core/scene/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

/// Some unit vector across `axis`, for points that lie on it.
Vector3d across(const Vector3d& axis) noexcept {
  return axis.cross(std::abs(axis.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
}

SurfaceDistance of_sphere(const Vector3d& from_centre, double radius) noexcept {
  const double r = from_centre.norm();
  return {r - radius, r > 0.0 ? Vector3d(from_centre / r) : Vector3d::UnitY()};
}

/// Greatest width W over which gradients turn inside a shape, and the sum S of two depths in its
/// middle.
struct Rounding {
  double width{0.0};   // [m]
  double depths{0.0};  // [m]
};

/// The greater of two distances inside, whose gradient turns from one to the other if they differ
/// by less than a width w (a polynomial smooth maximum). The sum s of both depths sets the width,
///
///     w = W u / (W S + u),  u = s (S - s)
///
/// which is 0 on the surface and in the middle, so that both stay where they are.
SurfaceDistance joined(const SurfaceDistance& one, const SurfaceDistance& other,
                       const Rounding& rounding) noexcept {
  const bool first = one.distance >= other.distance;
  const SurfaceDistance& near = first ? one : other;
  const SurfaceDistance& far = first ? other : one;
  const double apart = near.distance - far.distance;
  const double depths = -near.distance - far.distance;
  if (!(apart < rounding.width && depths < rounding.depths)) {
    return near;
  }
  const double u = depths * (rounding.depths - depths);
  const double whole = rounding.width * rounding.depths + u;
  const double width = rounding.width * u / whole;
  if (!(apart < width)) {
    return near;
  }
  const double share = 0.5 * (1.0 - apart / width);
  const double widens = rounding.width * rounding.width * rounding.depths *
                        (rounding.depths - 2.0 * depths) / (whole * whole);
  const double lost = share * (1.0 - share) * widens;
  const Vector3d gradient =
      (1.0 - share - lost) * near.slope * near.normal + (share - lost) * far.slope * far.normal;
  const double slope = gradient.norm();
  return {near.distance + share * share * width, gradient / slope, slope};
}

/// @param p  from the centre, along the box's own axes
SurfaceDistance of_box(const Vector3d& p, const Vector3d& half, const Rounding& rounding) noexcept {
  const Vector3d sign = p.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
  const Vector3d beyond = p.cwiseAbs() - half;
  const Vector3d out = beyond.cwiseMax(0.0);
  const double square = out.squaredNorm();
  if (square > 0.0) {
    const double distance = std::sqrt(square);
    return {distance, out.cwiseProduct(sign) / distance};
  }
  const auto face = [&](Eigen::Index axis) {
    return SurfaceDistance{beyond[axis], sign[axis] * Vector3d::Unit(axis)};
  };
  return joined(joined(face(0), face(1), rounding), face(2), rounding);
}

SurfaceDistance of_cylinder(const Vector3d& p, const Vector3d& axis, double radius,
                            double half_length, const Rounding& rounding) noexcept {
  const double along = axis.dot(p);
  const Vector3d aside = p - along * axis;
  const double r = aside.norm();
  const Vector3d outward = r > 0.0 ? Vector3d(aside / r) : across(axis);
  const Vector3d endward = along < 0.0 ? Vector3d(-axis) : axis;
  const double round = r - radius;
  const double flat = std::abs(along) - half_length;
  if (round > 0.0 && flat > 0.0) {
    const double distance = std::hypot(round, flat);
    return {distance, (round * outward + flat * endward) / distance};
  }
  const SurfaceDistance side{round, outward};
  const SurfaceDistance end{flat, endward};
  if (std::max(round, flat) > 0.0) {
    return round > flat ? side : end;
  }
  return joined(side, end, rounding);
}

SurfaceDistance finite_or_far(const SurfaceDistance& found) noexcept {
  return std::isfinite(found.distance) && found.normal.allFinite()
             ? found
             : SurfaceDistance{std::numeric_limits<double>::quiet_NaN(), Vector3d::UnitY()};
}

}  // namespace

PlacedShape::PlacedShape(const Shape& shape) {
  if (const auto* wall = std::get_if<HalfSpace>(&shape)) {
    kind_ = Kind::kHalfSpace;
    origin_ = wall->point;
    require(wall->normal.allFinite() && wall->normal.norm() > 0.0,
            "HalfSpace: normal must be finite and not zero");
    axis_ = wall->normal.normalized();
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    kind_ = Kind::kSphere;
    origin_ = sphere->centre;
    radius_ = sphere->radius;
    require(is_positive(radius_) && std::isfinite(radius_),
            "Sphere: radius must be finite and above 0");
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    kind_ = Kind::kBox;
    origin_ = box->centre;
    half_ = 0.5 * box->size;
    require(box->size.allFinite() && box->size.minCoeff() > 0.0,
            "Box: size must be finite and above 0");
    require(box->turn.allFinite(), "Box: turn must be finite");
    const double angle = box->turn.norm();
    if (angle > 0.0) {
      rotation_ = Eigen::AngleAxisd(angle, box->turn / angle).toRotationMatrix();
    }
  } else if (const auto* bar = std::get_if<Cylinder>(&shape)) {
    kind_ = Kind::kCylinder;
    origin_ = bar->centre;
    radius_ = bar->radius;
    half_length_ = 0.5 * bar->length;
    require(is_positive(radius_) && std::isfinite(radius_),
            "Cylinder: radius must be finite and above 0");
    require(is_positive(half_length_), "Cylinder: length must be above 0");
    require(bar->axis.allFinite() && bar->axis.norm() > 0.0,
            "Cylinder: axis must be finite and not zero");
    axis_ = bar->axis.normalized();
  } else if (const auto* registered = std::get_if<RegisteredShape>(&shape)) {
    kind_ = Kind::kRegistered;
    law_ = registered->law;
    require(law_ != nullptr, "Shape: has no law");
    require(is_positive(law_->deepest()), "Shape: its deepest point must be above 0");
  }
  require(origin_.allFinite(), "Shape: point or centre must be finite");
}

SurfaceDistance PlacedShape::distance(const Vector3d& p, double rounding) const noexcept {
  const Vector3d from = p - origin_;
  const Rounding inside{rounding, 2.0 * deepest()};
  switch (kind_) {
    case Kind::kHalfSpace:
      return {axis_.dot(from), axis_};
    case Kind::kSphere:
      return of_sphere(from, radius_);
    case Kind::kBox: {
      SurfaceDistance found = of_box(rotation_.transpose() * from, half_, inside);
      found.normal = rotation_ * found.normal;
      return found;
    }
    case Kind::kCylinder:
      return of_cylinder(from, axis_, radius_, half_length_, inside);
    case Kind::kRegistered:
      return finite_or_far(law_->distance(p));
  }
  return {};
}

double PlacedShape::deepest() const noexcept {
  switch (kind_) {
    case Kind::kHalfSpace:
      break;
    case Kind::kSphere:
      return radius_;
    case Kind::kBox:
      return half_.minCoeff();
    case Kind::kCylinder:
      return std::min(radius_, half_length_);
    case Kind::kRegistered:
      return law_->deepest();
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace haptrial::scene
