#include "analysis/contact/demo_study/ridge.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::evaluation {

double Ridge::foot() const { return -0.5 * top - height / std::tan(flank); }

geometry::Mesh ridge_mesh(const Ridge& r) {
  if (!(r.height > 0.0 && r.top > 0.0 && r.thickness > 0.0 && r.half_width > 0.0)) {
    throw std::invalid_argument("a ridge's height, top, thickness and half_width must be above 0");
  }
  if (!(r.flank > 0.0 && r.flank < 0.5 * std::numbers::pi && r.half_length > -r.foot())) {
    throw std::invalid_argument(
        "a ridge's flank must be inside (0, pi / 2), and half_length beyond its feet");
  }
  // The cross-section from above, anticlockwise seen from +z, and the front and back of it.
  const double foot = r.foot();
  const std::array<Eigen::Vector2d, 8> outline{{{-r.half_length, -r.thickness},
                                                {r.half_length, -r.thickness},
                                                {r.half_length, 0.0},
                                                {-foot, 0.0},
                                                {0.5 * r.top, r.height},
                                                {-0.5 * r.top, r.height},
                                                {foot, 0.0},
                                                {-r.half_length, 0.0}}};
  geometry::Mesh mesh;
  for (const double z : {r.half_width, -r.half_width}) {
    for (const Eigen::Vector2d& p : outline) {
      mesh.vertices.emplace_back(p.x(), p.y(), z);
    }
  }
  for (std::int32_t i = 0; i < 8; ++i) {
    const std::int32_t j = (i + 1) % 8;
    mesh.triangles.push_back({i, i + 8, j});
    mesh.triangles.push_back({j, i + 8, j + 8});
  }
  for (const geometry::Triangle& t :
       {geometry::Triangle{0, 6, 7}, geometry::Triangle{0, 1, 6}, geometry::Triangle{1, 3, 6},
        geometry::Triangle{1, 2, 3}, geometry::Triangle{3, 4, 6}, geometry::Triangle{4, 5, 6}}) {
    mesh.triangles.push_back(t);
    mesh.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  return mesh;
}

}  // namespace haptrial::evaluation
