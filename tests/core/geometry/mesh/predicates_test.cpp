#include "core/geometry/mesh/predicates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::geometry {
namespace {

__extension__ typedef __int128 Wide;  // holds every determinant below

int sign_of(Wide value) { return (value > 0) - (value < 0); }

/// Whole numbers below 2^25, of which a __int128 holds every determinant.
struct Whole {
  std::int64_t x, y, z;
  Eigen::Vector3d point(double scale) const {
    return scale *
           Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }
};

int exact_plane(const Whole& a, const Whole& b, const Whole& c, const Whole& p) {
  const Wide ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const Wide vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const Wide wx = p.x - a.x, wy = p.y - a.y, wz = p.z - a.z;
  return sign_of((uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz);
}

class PredicatesTest : public ::testing::Test {
 protected:
  Whole any(std::int64_t range) {
    const auto one = [&] {
      return static_cast<std::int64_t>(random_.below(2 * static_cast<std::uint64_t>(range))) -
             range;
    };
    return {one(), one(), one()};
  }
  RandomStream random_{1, "predicates"};
};

TEST_F(PredicatesTest, SidesOfPlanesAreThoseOfWholeNumbers) {
  int zeros = 0;
  for (int i = 0; i < 200000; ++i) {
    // Small ranges give many points in a plane; powers of two keep whole numbers whole.
    const std::int64_t range = i % 4 == 0 ? 2 : i % 4 == 1 ? 50 : 1 << 25;
    const double scale = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 0x1p-60 : 0x1p70;
    const Whole a = any(range), b = any(range), c = any(range);
    Whole p = any(range);
    if (i % 4 == 3) {  // in the plane, or one step beside it
      const std::int64_t step = static_cast<std::int64_t>(random_.below(3)) - 1;
      p = {b.x + c.x - a.x + step, b.y + c.y - a.y, b.z + c.z - a.z};
    }
    const int expected = exact_plane(a, b, c, p);
    zeros += expected == 0;
    ASSERT_EQ(side_of_plane(a.point(scale), b.point(scale), c.point(scale), p.point(scale)),
              expected);
    ASSERT_EQ(side_of_plane(b.point(scale), a.point(scale), c.point(scale), p.point(scale)),
              -expected);
  }
  EXPECT_GT(zeros, 20000);
}

TEST_F(PredicatesTest, SidesOfLinesAreThoseOfWholeNumbers) {
  int zeros = 0;
  for (int i = 0; i < 200000; ++i) {
    const std::int64_t range = i % 2 == 0 ? 3 : 1 << 30;
    const Whole a = any(range), b = any(range);
    Whole p = any(range);
    if (i % 4 == 3) {
      p = {2 * b.x - a.x, 2 * b.y - a.y + static_cast<std::int64_t>(random_.below(2)), 0};
    }
    const int expected = sign_of(Wide(b.x - a.x) * (p.y - a.y) - Wide(b.y - a.y) * (p.x - a.x));
    zeros += expected == 0;
    ASSERT_EQ(side_of_line(a.point(1.0).head<2>(), b.point(1.0).head<2>(), p.point(1.0).head<2>()),
              expected);
  }
  EXPECT_GT(zeros, 20000);
}

TEST_F(PredicatesTest, TheLastBitOfACoordinateIsSeen) {
  const Eigen::Vector2d a(0.1, 0.1), b(12.0, 12.0);
  const double x = 24.3;
  EXPECT_EQ(side_of_line(a, b, {x, x}), 0);
  EXPECT_EQ(side_of_line(a, b, {x, std::nextafter(x, 100.0)}), 1);
  EXPECT_EQ(side_of_line(a, b, {x, std::nextafter(x, 0.0)}), -1);
  const Eigen::Vector3d p(1e-3, 2e-3, 0.5), q(1e5, -3.0, 0.5), r(-7.0, 1e6, 0.5);
  EXPECT_EQ(side_of_plane(p, q, r, {4.0, 5.0, 0.5}), 0);
  EXPECT_EQ(side_of_plane(p, q, r, {4.0, 5.0, std::nextafter(0.5, 1.0)}), 1);
  EXPECT_EQ(side_of_plane(p, q, r, {4.0, 5.0, std::nextafter(0.5, 0.0)}), -1);
}

}  // namespace
}  // namespace haptrial::geometry
