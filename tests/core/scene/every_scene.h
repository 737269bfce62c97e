#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh/procedural.h"
#include "core/scene/field.h"

namespace haptrial::test {}

namespace haptrial::scene::test {

using namespace haptrial::test;  // helpers of all tests, beside those of this folder

inline const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

/// A small scene for the laws that hold for many fields; its surfaces pass near the origin.
struct Example {
  std::string name;
  std::vector<Field> fields;
};

inline Field field(std::string name, FieldKind kind, double limit = 10.0) {
  return {std::move(name), std::move(kind), limit, 0.0, 0.0};
}

inline Field surface(Shape shape, bool inside = false, double damping = 2.0) {
  return field("floor", SurfaceParameters{shape, inside, {800.0, damping}});
}

/// A torus that lies askew, of 1,536 triangles.
inline Field solid(const contact::Friction& friction = {}, double tool_radius = 0.0) {
  static const auto body =
      std::make_shared<const contact::FeltBody>(geometry::make_torus(0.01, 0.004, 48, 16));
  RigidObjectParameters p;
  p.body = body;
  p.pose = {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 0).normalized())),
            {0.002, 0.0, -0.001}};
  p.scale = 1.2;
  p.gains = {800.0, 2.0};
  p.friction = friction;
  p.tool_radius = tool_radius;
  return field("floor", std::move(p));
}

/// Fields whose force at rest is minus the gradient of an energy.
inline std::vector<Example> conservative_scenes() {
  const Shape floor = HalfSpace{{0.0, 0.002, 0.0}, {0.1, 1.0, -0.2}};
  const Shape ball = Sphere{{0.003, 0.0, 0.0}, 0.02};
  const Shape block = Box{{0.0, -0.004, 0.0}, {0.04, 0.03, 0.05}, {0.3, 0.2, -0.5}};
  const Shape bar = Cylinder{{0.0, 0.0, 0.003}, {1.0, 0.4, 0.0}, 0.015, 0.03};
  GratingParameters ridges{"floor", {1.0, 0.0, 0.3}, 2e-4, 0.004};
  const Field sines = field("ridges", ridges);
  ridges.profile = GratingParameters::Profile::kRounded;
  const Field rounded = field("ridges", ridges);
  const Field rough =
      field("rough", TextureParameters{"floor", {0.1, 1.0, -0.2}, 5e-5, 100.0, 400.0, 3});
  return {
      {"constant", {field("push", ConstantParameters{{1.0, -2.0, 0.5}})}},
      {"spring", {field("spring", SpringParameters{{0.005, 0.0, 0.0}, {600.0, 5.0}})}},
      {"line", {field("line", LineChannelParameters{kOrigin, {0.1, 0.02, -0.05}, {1500.0, 20.0}})}},
      {"axes", {field("axes", AxisChannelParameters{kOrigin, true, false, true, {1000.0, 15.0}})}},
      {"plane", {field("plane", PlaneParameters{kOrigin, {1.0, 1.0, 0.0}, {1000.0, 15.0}})}},
      {"wall", {surface(floor)}},
      {"ball from outside", {surface(ball)}},
      {"ball from inside", {surface(ball, true)}},
      {"block from outside", {surface(block)}},
      {"block from inside", {surface(block, true)}},
      {"bar from outside", {surface(bar)}},
      {"bar from inside", {surface(bar, true)}},
      {"ridges on a wall", {sines, surface(floor)}},
      {"soft ridges on a wall", {surface(floor), rounded}},
      {"rough wall", {surface(floor), rough}},
      {"ridged and rough ball", {surface(ball), sines, rough}},
      {"ridges within a ball", {surface(ball, true), sines}},
      {"detents", {field("detent", DetentParameters{kOrigin, {1.0, 0.2, 0.0}, 0.008, 1.0})}},
      {"three detents",
       {field("detent", DetentParameters{kOrigin, {1.0, 0.2, 0.0}, 0.008, 1.0, 3})}},
      {"click", {field("click", ClickParameters{})}},
      {"many",
       {surface(floor), sines, rough, field("spring", SpringParameters{}),
        field("click", ClickParameters{}), field("push", ConstantParameters{{0.5, 0.0, 0.0}})}},
  };
}

/// Passive scenes: those of springs, and the others that take energy from every hand.
/// A curve with a corner and a bow, about the origin.
inline std::vector<Eigen::Vector3d> bent_curve() {
  std::vector<Eigen::Vector3d> points{{-0.03, 0.0, 0.01}, {-0.01, 0.005, 0.01}};
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.05 * i;
    points.emplace_back(0.015 * std::sin(angle), 0.002 * angle, -0.015 * std::cos(angle));
  }
  return points;
}

inline std::vector<Example> passive_scenes() {
  std::vector<Example> all = conservative_scenes();
  using Model = FrictionParameters::Model;
  const Shape floor = HalfSpace{{0.0, 0.002, 0.0}, {0.1, 1.0, -0.2}};
  const Field ridges = field("ridges", GratingParameters{"floor", {1.0, 0.0, 0.3}, 2e-4, 0.004});
  const Field rubbing = field("rubbing", FrictionParameters{"floor", 0.6, 0.4, 1500.0});
  MatrixViscousParameters matrix;
  matrix.matrix << -8.0, 2.0, 0.0, 2.0, -5.0, 1.0, 0.0, 1.0, -1.0;
  const std::vector<Example> others{
      {"curve", {field("curve", CurveParameters{bent_curve(), {600.0, 4.0}})}},
      {"viscous", {field("oil", ViscousParameters{8.0})}},
      {"viscous, filtered", {field("oil", ViscousParameters{8.0, 25.0})}},
      {"matrix", {field("oil", matrix)}},
      {"friction", {field("dry", FrictionParameters{"", 0.8, 0.8, 1000.0})}},
      {"stick-slip", {field("dry", FrictionParameters{"", 1.6, 0.8, 1000.0})}},
      {"Dahl", {field("dry", FrictionParameters{"", 0.8, 0.8, 1000.0, Model::kDahl})}},
      {"rubbing wall", {surface(floor), rubbing}},
      {"rubbing ridges", {rubbing, ridges, surface(floor)}},
      {"rubbing ball", {surface(Sphere{kOrigin, 0.02}, true), rubbing}},
      {"rubbing block", {surface(Box{kOrigin, {0.04, 0.03, 0.05}}), rubbing}},
      {"torus", {solid()}},
      {"torus felt by a ball", {solid({}, 0.002)}},
      {"sticky torus", {solid({0.5, 0.3})}},
      {"ridged torus", {solid(), ridges}},
      {"rubbing torus", {solid(), rubbing}},
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace haptrial::scene::test
