#include "core/scene/read/field_kinds_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/random.h"

namespace haptrial::scene {
namespace {

/// A random path as the force study draws it.
struct RandomCurve {
  stimulus::TrajectoryParameters shape;
  std::uint64_t seed{0};
};

const Schema<stimulus::TrajectoryParameters>& curve_shape_schema() {
  using P = stimulus::TrajectoryParameters;
  static const auto schema =
      Schema<P>()
          .number("length_x", &P::length_x, kLengthBounds, "m",
                  "Extent of a random path from left to right")
          .required()
          .number("range_z", &P::range_z, kLengthBounds, "m", "Extent of a random path across")
          .required()
          .custom("sinusoids", "Number of sinusoids whose sum is a random path",
                  [](Table& table, const std::string& key, P& p) {
                    p.sinusoids = static_cast<int>(table.number(key, {1.0, 1000.0}, ""));
                  })
          .otherwise(fmt::format("{}", P{}.sinusoids))
          .number("max_spatial_frequency", &P::max_spatial_frequency, {0.1, 1000.0}, "cycles/m",
                  "Highest spatial frequency of the sinusoids of a random path");
  return schema;
}

const Schema<RandomCurve>& random_curve_schema() {
  static const auto schema = Schema<RandomCurve>()
                                 .keys_of(&RandomCurve::shape, curve_shape_schema())
                                 .seed("seed", &RandomCurve::seed, kSeed)
                                 .required();
  return schema;
}

std::vector<Eigen::Vector3d> read_curve(Table& table) {
  Table inner = table.table("curve");
  const RandomCurve curve = random_curve_schema().read(inner);
  RandomStream random(curve.seed, "path");
  return stimulus::SpatialTrajectory(curve.shape, random).points();
}

void read_points(Table& table, std::vector<Eigen::Vector3d>& into) {
  const bool both = table.has("points") && table.has("curve");
  if (both) {
    table.reject("curve", "stands beside points; keep one of the two");
    static_cast<void>(read_vectors(table, "points", kPlaceBounds, "m"));
  }
  std::vector<Eigen::Vector3d> points =
      table.has("curve") ? read_curve(table) : read_vectors(table, "points", kPlaceBounds, "m");
  const bool moves = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& each) {
    return each != points.front();
  });
  if (moves) {
    into = std::move(points);
  } else {
    table.reject("points", "go nowhere; write two places or more that are not the same");
  }
}

/// points, or a curve
template <class P>
Schema<P> points_schema() {
  return Schema<P>()
      .custom("points", "Places that a path or curve goes through",
              [](Table& table, const std::string&, P& p) { read_points(table, p.points); })
      .required()
      .otherwise("needed; or a curve");
}

const Schema<PathParameters>& path_schema() {
  using P = PathParameters;
  static const auto schema = points_schema<P>()
                                 .number("duration", &P::duration, kDurationBounds, "s",
                                         "Duration of a pulse or of a movement")
                                 .required()
                                 .keys_of(&P::gains, field_gains_schema());
  return schema;
}

const Schema<CurveParameters>& curve_schema() {
  using P = CurveParameters;
  static const auto schema = points_schema<P>().keys_of(&P::gains, field_gains_schema());
  return schema;
}

}  // namespace

KindOfField path_field() { return {"path", read_by<PathParameters, path_schema>}; }

KindOfField curve_field() { return {"curve", read_by<CurveParameters, curve_schema>}; }

}  // namespace haptrial::scene
