// How far is a tool from a surface, and where on a curve is it? Another project's program on top of
// the installed libraries.

#include <core/control/sampled_curve.h>
#include <core/geometry/bvh/bvh.h>
#include <core/geometry/mesh/procedural.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

int main() {
  using namespace haptrial;

  // A sphere of 5 cm, and a tool 2 cm outside of it.
  const geometry::Bvh surface(geometry::make_sphere(0.05, 40));
  const Eigen::Vector3d tool(0.07, 0.0, 0.0);
  const geometry::ClosestPoint nearest = surface.closest(tool);
  std::printf("distance %.6f m, inside: %s\n", std::sqrt(nearest.distance_squared),
              surface.contains(tool) ? "yes" : "no");

  // A circle that begins at the top: the tool is nearest to the place three quarters around.
  std::vector<Eigen::Vector3d> circle;
  for (int i = 0; i <= 3600; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 900) / 3600.0;
    circle.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0);
  }
  const control::SampledCurve curve(circle);
  const control::CurvePlace place = curve.nearest(tool);
  std::printf("along the curve %.6f m of %.6f m\n", place.arc, curve.length());
}
