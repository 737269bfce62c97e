#include "core/control/sampled_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/neighbour_method.h"

namespace haptrial::control::sampled_curve_test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

Vector3d random_vector(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// The distance by looking at every segment, in extended precision; only arcs within the window.
long double by_hand(const Points& points, const Vector3d& tool, const ArcWindow& window = {}) {
  long double best = std::numeric_limits<long double>::infinity();
  long double arc = 0.0L;
  using Vector = Eigen::Matrix<long double, 3, 1>;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector from = points[i].cast<long double>();
    const Vector chord = points[i + 1].cast<long double>() - from;
    const long double length = chord.norm();
    const auto part = [&](double at) {
      return length > 0.0L ? std::clamp((at - arc) / length, 0.0L, 1.0L) : 0.0L;
    };
    if (arc <= window.high && arc + length >= window.low) {
      const Vector away = tool.cast<long double>() - from;
      const long double t = length > 0.0L ? away.dot(chord) / (length * length) : 0.0L;
      const long double held = std::clamp(t, part(window.low), part(window.high));
      best = std::min(best, (away - held * chord).norm());
    }
    arc += length;
  }
  return best;
}

/// A family of curves; `size` is their extent and `where` their middle.
Points make_curve(const std::string& kind, std::size_t count, double size, const Vector3d& where,
                  RandomStream& random) {
  Points points(count);
  Vector3d walk = Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    if (kind == "scattered") {
      points[i] = random_vector(random, 1.0);
    } else if (kind == "walk") {
      points[i] = walk += random_vector(random, 2.0 / std::sqrt(static_cast<double>(count)));
    } else if (kind == "crossing") {  // in a plane, through itself
      points[i] = {std::sin(3.0 * a), 0.0, std::sin(5.0 * a + 0.2)};
    } else if (kind == "smooth") {
      points[i] = {std::cos(2.0 * a), std::sin(3.0 * a + 0.4), 0.5 * std::sin(a)};
    } else if (kind == "duplicates") {  // runs of points that are the same
      points[i] = i > 0 && random.below(3) > 0 ? points[i - 1] : random_vector(random, 1.0);
    } else if (kind == "straight") {
      points[i] = {static_cast<double>(i) / static_cast<double>(count), 0.0, 0.0};
    } else if (kind == "back and forth") {  // over itself
      points[i] = {std::abs(std::fmod(static_cast<double>(i) / 10.0, 2.0) - 1.0), 0.0, 0.0};
    } else if (kind == "uneven") {  // segments of very unequal lengths
      walk += std::pow(10.0, random.uniform(-9.0, 0.0)) * random_vector(random, 0.3);
      points[i] = walk;
    } else {
      points[i] = Vector3d(0.3, -0.2, 0.1);  // "a point"
    }
  }
  for (Vector3d& p : points) {
    p = where + size * p;
  }
  return points;
}

const std::vector<std::string> kKinds{"scattered",      "walk",       "crossing",
                                      "smooth",         "duplicates", "straight",
                                      "back and forth", "uneven",     "a point"};

/// A tool somewhere about the curve: on a vertex, on a segment, near, in the box, far away.
Vector3d make_tool(const Points& points, double size, RandomStream& random) {
  const std::size_t i = random.below(points.size() - 1);
  switch (random.below(5)) {
    case 0:
      return points[i];
    case 1:
      return points[i] + random.uniform() * (points[i + 1] - points[i]);
    case 2:
      return points[i] + random_vector(random, 1e-3 * size);
    case 3:
      return points[i] + random_vector(random, size);
    default:
      return points[i] + random_vector(random, 1e3 * size);
  }
}

struct Frame {
  double size;
  double offset;
};
const std::vector<Frame> kFrames{{1.0, 0.0},  {1e-6, 0.0}, {1e6, 0.0},
                                 {1e-6, 1.0}, {1.0, 1e6},  {1e-12, 0.0}};

TEST(SampledCurveTest, NearestIsThatOfBruteForce) {
  RandomStream random(1, "nearest");
  int queries = 0;
  for (const std::string& kind : kKinds) {
    for (const Frame& frame : kFrames) {
      for (const std::size_t count : {2u, 3u, 8u, 9u, 10u, 65u, 66u, 1000u}) {
        const Vector3d where = Vector3d::Constant(frame.offset);
        const Points points = make_curve(kind, count, frame.size, where, random);
        const SampledCurve curve(points);
        for (int i = 0; i < 30; ++i, ++queries) {
          const Vector3d tool = make_tool(points, frame.size, random);
          const CurvePlace place = curve.nearest(tool);
          const auto truth = static_cast<double>(by_hand(points, tool));
          // Rounding of a coordinate, of the curve's extent and of the distance itself.
          const double rounding = 4e-15 * (frame.size + frame.offset + truth);
          ASSERT_NEAR(place.distance, truth, rounding) << kind << " " << count << " " << i;
          ASSERT_NEAR((tool - place.position).norm(), place.distance, rounding);
          ASSERT_LT(place.segment, count - 1);
        }
      }
    }
  }
  EXPECT_EQ(queries, 9 * 6 * 8 * 30);
}

TEST(SampledCurveTest, APlaceIsOnItsSegmentAtItsArc) {
  RandomStream random(2, "places");
  for (const std::string& kind : kKinds) {
    const Points points = make_curve(kind, 300, 1.0, Vector3d::Zero(), random);
    const SampledCurve curve(points);
    std::vector<double> arc(points.size(), 0.0);
    for (std::size_t i = 1; i < points.size(); ++i) {
      arc[i] = arc[i - 1] + (points[i] - points[i - 1]).norm();
    }
    ASSERT_NEAR(curve.length(), arc.back(), 1e-12);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(curve.point(i), points[i]);
      ASSERT_NEAR(curve.arc(i), arc[i], 1e-12);
    }
    for (int i = 0; i < 300; ++i) {
      const CurvePlace p = curve.nearest(make_tool(points, 1.0, random));
      const Vector3d on = points[p.segment] + p.t * (points[p.segment + 1] - points[p.segment]);
      ASSERT_GE(p.t, 0.0);
      ASSERT_LE(p.t, 1.0);
      ASSERT_LT((on - p.position).norm(), 1e-14);
      ASSERT_NEAR(p.arc, arc[p.segment] + p.t * (arc[p.segment + 1] - arc[p.segment]), 1e-12);
      ASSERT_LT((curve.at(p.arc).position - p.position).norm(), 1e-7) << "and back from the arc";
    }
  }
}

TEST(SampledCurveTest, WithinAWindowItIsBruteForceWithinTheWindow) {
  RandomStream random(3, "windows");
  int found = 0;
  for (const std::string& kind : kKinds) {
    for (const std::size_t count : {2u, 9u, 70u, 1000u}) {
      const Points points = make_curve(kind, count, 1.0, Vector3d::Zero(), random);
      const SampledCurve curve(points);
      for (int i = 0; i < 200; ++i) {
        const Vector3d tool = make_tool(points, 1.0, random);
        const double middle = random.uniform(0.0, curve.length());
        const double half = curve.length() * std::pow(10.0, random.uniform(-6.0, 0.0));
        CurveQuery query;
        query.window = {middle - half, middle + half};
        query.from_segment = random.below(count - 1);
        const auto place = curve.nearest(tool, query);
        ASSERT_TRUE(place) << kind << ": a window about a place of the curve is never empty";
        const auto truth = static_cast<double>(by_hand(points, tool, query.window));
        const double rounding = 1e-13 * (curve.length() + truth);
        ASSERT_NEAR(place->distance, truth, rounding) << kind << " " << count << " " << i;
        ASSERT_GE(place->arc, query.window.low - rounding);
        ASSERT_LE(place->arc, query.window.high + rounding);
        query.below = place->distance * (1.0 - 1e-12);
        ASSERT_FALSE(curve.nearest(tool, query)) << "nothing is nearer than the nearest";
        query.below = place->distance * (1.0 + 1e-9) + 1e-100;
        found += curve.nearest(tool, query).has_value();
      }
    }
  }
  EXPECT_EQ(found, 9 * 4 * 200);
}

TEST(SampledCurveTest, AStretchThatIsKnownChangesNothing) {
  RandomStream random(4, "known");
  for (const std::string kind : {"walk", "crossing", "uneven"}) {
    const Points points = make_curve(kind, 2000, 1.0, Vector3d::Zero(), random);
    const SampledCurve curve(points);
    for (int i = 0; i < 300; ++i) {
      const Vector3d tool = make_tool(points, 1.0, random);
      const double middle = random.uniform(0.0, curve.length());
      const double half = curve.length() * std::pow(10.0, random.uniform(-4.0, -1.0));
      CurveQuery inner;
      inner.window = {middle - half, middle + half};
      inner.from_segment = curve.at(middle).segment;
      const auto near = curve.nearest(tool, inner);
      CurveQuery outer = inner;
      outer.window = {middle - 5.0 * half, middle + 5.0 * half};
      outer.below = near->distance * (1.0 - 1e-12);
      const auto plain = curve.nearest(tool, outer);
      outer.known = inner.window;
      const auto spared = curve.nearest(tool, outer);
      ASSERT_EQ(plain.has_value(), spared.has_value()) << kind << i;
      if (plain) {
        ASSERT_EQ(plain->distance, spared->distance);
      }
    }
  }
}

TEST(SampledCurveTest, TheSourcesMethodAgreesWhereItSeesEnoughNeighbours) {
  RandomStream random(5, "source");
  for (const std::string kind : {"smooth", "crossing", "walk"}) {
    test::NeighbourMethod source(make_curve(kind, 400, 1.0, Vector3d::Zero(), random));
    const SampledCurve curve(source.points());
    int fewer_were_wrong = 0;
    for (int i = 0; i < 300; ++i) {
      const Vector3d tool = make_tool(source.points(), 1.0, random);
      const double ours = curve.nearest(tool).distance;
      const auto all = source.nearest_points(tool, 400);
      ASSERT_NEAR(source.place(tool, all, std::nullopt, 0.0).distance, ours, 1e-12 * (1.0 + ours));
      const auto one = source.nearest_points(tool, 1);
      fewer_were_wrong += source.place(tool, one, std::nullopt, 0.0).distance > ours + 1e-9;
    }
    if (std::string(kind) == "walk") {
      EXPECT_GT(fewer_were_wrong, 0) << "Figure 45: one neighbour is not enough";
    }
  }
}

TEST(SampledCurveTest, TheTangentIsPerpendicularToTheLineToTheTool) {
  RandomStream random(7, "tangent");
  int corners = 0;
  for (const std::string kind : {"smooth", "walk", "crossing", "duplicates"}) {
    const Points points = make_curve(kind, 200, 1.0, Vector3d::Zero(), random);
    const SampledCurve curve(points);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d tool = make_tool(points, 1.0, random);
      const CurvePlace place = curve.nearest(tool);
      if (place.arc <= 0.0 || place.arc >= curve.length()) {
        continue;
      }
      const Vector3d tangent = curve.tangent(place, tool);
      ASSERT_NEAR(tangent.norm(), 1.0, 1e-12);
      ASSERT_LT(std::abs(tangent.dot(tool - place.position)), 1e-9 * (1.0 + place.distance))
          << kind << i << " t " << place.t << " arc " << place.arc << " of " << curve.length();
      corners += place.t == 0.0 || place.t == 1.0;
    }
  }
  EXPECT_GT(corners, 100);
  const SampledCurve corner(Points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 1}});
  EXPECT_LT((corner.tangent(corner.at(0.0), {0, 1, 0}) - Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((corner.tangent(corner.at(2.0), {0, 1, 0}) - Vector3d(0, 0, 1)).norm(), 1e-15);
  const Vector3d outside(1.3, 0.0, -0.3);
  EXPECT_LT(
      (corner.tangent(corner.nearest(outside), outside) - Vector3d(1, 0, 1).normalized()).norm(),
      1e-12);
  const SampledCurve point(Points(5, Vector3d::Ones()));
  EXPECT_TRUE(point.tangent(point.at(0.0), {0, 0, 0}).isZero());
}

TEST(SampledCurveTest, ToolsThatAreNowhereAreAnswered) {
  const SampledCurve curve(Points{{0, 0, 0}, {1, 0, 0}});
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    EXPECT_TRUE(std::isinf(curve.nearest({0.5, bad, 0.0}).distance));
    EXPECT_FALSE(curve.nearest({0.5, bad, 0.0}, CurveQuery{}));
  }
  EXPECT_FALSE(curve.nearest({0.5, 0.0, 0.0}, CurveQuery{{2.0, 3.0}})) << "beyond the curve";
  EXPECT_EQ(curve.at(-1.0).arc, 0.0);
  EXPECT_EQ(curve.at(7.0).arc, 1.0);
  EXPECT_NEAR(curve.nearest({0.5, 1e99, 0.0}).distance, 1e99, 1e84);
}

TEST(SampledCurveTest, PointsThatAreNoCurveAreRefused) {
  EXPECT_THROW(SampledCurve(Points{}), std::invalid_argument);
  EXPECT_THROW(SampledCurve(Points{{1, 2, 3}}), std::invalid_argument);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           -std::numeric_limits<double>::infinity(), 1e101}) {
    EXPECT_THROW(SampledCurve(Points{{1, 2, 3}, {bad, 0, 0}}), std::invalid_argument);
  }
}

TEST(SampledCurveTest, AQueryDoesNotAllocate) {
  RandomStream random(8, "allocation");
  const Points points = make_curve("walk", 5000, 1.0, Vector3d::Zero(), random);
  const SampledCurve curve(points);
  double sum = 0.0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d tool = make_tool(points, 1.0, random);
    const CurvePlace place = curve.nearest(tool);
    sum += place.distance + curve.tangent(place, tool).x();
    CurveQuery query;
    query.window = {place.arc - 0.1, place.arc + 0.1};
    query.from_segment = place.segment;
    sum += curve.nearest(tool, query)->distance;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

TEST(SampledCurveTest, TwoMillionPointsAreSearchedExactly) {
  // A helix, whose nearest place is known in closed form on its axis and near its surface.
  constexpr std::size_t kCount = 2000000;
  constexpr double kPitch = 1e-4;  // rise per radian [m]
  Points points(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double a = 200.0 * static_cast<double>(i) / kCount;
    points[i] = {0.05 * std::cos(a), kPitch * a, 0.05 * std::sin(a)};
  }
  const SampledCurve curve(points);
  const double speed = std::hypot(0.05, kPitch);
  EXPECT_NEAR(curve.length(), 200.0 * speed * (kCount - 1) / kCount, 1e-8);
  RandomStream random(9, "helix");
  for (int i = 0; i < 2000; ++i) {
    // Straight outwards from a place: the normal of a helix is radial.
    const double a = random.uniform(1.0, 199.0);
    const double radius = random.uniform(0.04995, 0.06);
    const Vector3d tool(radius * std::cos(a), kPitch * a, radius * std::sin(a));
    const CurvePlace place = curve.nearest(tool);
    ASSERT_NEAR(place.distance, std::abs(radius - 0.05), 1e-9);
    ASSERT_NEAR(place.arc, a * speed, 1e-6);
  }
}

}  // namespace
}  // namespace haptrial::control::sampled_curve_test
