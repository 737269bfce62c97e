#include "core/contact/parted_triangles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "core/base/random.h"
#include "core/contact/sweep.h"
#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Corners;

/// Triangles from far smaller to far larger than the list's reach, moves that touch, graze and
/// miss: what the list passes over must not be met, whichever planes it has.
TEST(PartedTrianglesTest, WhatIsPassedOverIsNotMet) {
  for (const double scale : {1e-6, 1.0, 1e5}) {
    for (const double offset : {0.0, 1000.0}) {
      RandomStream random(5, "parted");
      const auto cube = [&](double reach) -> Vector3d {
        const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
        return Vector3d(x, y, random.uniform(-reach, reach)) * scale;
      };
      const Vector3d middle = offset * Vector3d(1.0, -2.0, 0.5) * scale;
      int met = 0, passed = 0;
      for (int list = 0; list < 60; ++list) {
        PartedTriangles parted(64);
        std::vector<Corners> triangles;
        std::vector<PartedTriangles::Candidate> found(64);
        parted.clear(middle, 2.0 * scale);
        const double radius = list % 2 == 0 ? 0.0 : 0.5 * scale;
        for (int i = 0; i < 41; ++i) {
          const double size = std::pow(10.0, random.uniform(-3.0, 3.0));
          const Vector3d a = middle + cube(1.0);
          triangles.push_back({a, a + cube(size), a + cube(size)});
          parted.add(i, triangles.back());
        }
        parted.part_all(middle + cube(0.2));
        for (int sweep = 0; sweep < 200; ++sweep) {
          const Vector3d from = middle + cube(0.7);
          const Vector3d move = std::pow(10.0, random.uniform(-9.0, 0.0)) * cube(0.7);
          const Skin skin = Skin::of((3.0 + 2000.0 * (offset > 0.0)) * scale);
          const double off = radius + 1.25 * skin.thickness;
          const auto in_list = parted.in_list(from, move, off);
          const int count = parted.within(in_list, found);
          std::set<int> candidates;
          std::map<int, double> soonest;
          for (int k = 0; k < count; k += PartedTriangles::kTogether) {
            const auto few =
                std::span(found).subspan(k, std::min(PartedTriangles::kTogether, count - k));
            const auto left =
                few.first(sweep % 2 == 0 ? parted.part_anew(in_list, few) : few.size());
            for (const auto& candidate : left) {
              candidates.insert(candidate.i);
              soonest[candidate.i] = candidate.t;
            }
          }
          for (int i = 0; i < parted.size(); ++i) {
            const Corners& c = triangles[parted.slot(i)];
            const Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
            SweepHit hit;
            Hull hull;
            hull.wrap(c, n, i);
            Vector3d apart = Vector3d::Zero();
            const Sweep way{from, move, radius, skin};
            const auto meets_before = [&](double end) {
              return radius > 0.0 ? sweep_sphere(way, c, n, hull, end, hit, apart)
                                  : sweep_point(way, hull, end, hit, apart);
            };
            const bool meets = meets_before(1.0);
            ASSERT_TRUE(!meets || candidates.contains(i)) << list << ", " << sweep << ", " << i;
            ASSERT_TRUE(!meets || soonest[i] <= 0.0 || !meets_before(soonest[i]))
                << list << ", " << sweep << ", " << i;
            met += meets;
            passed += !candidates.contains(i);
            const Vector3d out = from - geometry::closest_on_triangle(from, c[0], c[1], c[2]).point;
            if (sweep % 3 == 0 && out.norm() > 0.0) {
              parted.part(i, c, out.normalized());
            }
          }
        }
      }
      EXPECT_GT(met, 5000);
      EXPECT_GT(passed, 50000);
    }
  }
}

TEST(PartedTrianglesTest, AMoveIsNotMetBeforeItsPart) {
  // A plate across the way at half of it; one aside that the planes keep away.
  PartedTriangles parted(8);
  std::vector<PartedTriangles::Candidate> found(8);
  const Corners across = {Vector3d(1, -5, -5), Vector3d(1, 5, -5), Vector3d(1, 0, 5)};
  const Corners aside = {Vector3d(0, 3, 0), Vector3d(1, 3, 0), Vector3d(0, 4, 0)};
  parted.clear(Vector3d::Zero(), 2.0);
  parted.add(7, aside);
  parted.add(9, across);
  parted.part_all(Vector3d::Zero());
  parted.part(1, across, Vector3d(-1, 0, 0));
  const auto count =
      parted.within(parted.in_list(Vector3d::Zero(), Vector3d(2, 0, 0), 0.25), found);
  ASSERT_EQ(count, 1);
  EXPECT_EQ(parted.slot(found[0].i), 9);
  EXPECT_DOUBLE_EQ(found[0].t, 0.375);
}

}  // namespace
}  // namespace haptrial::contact
