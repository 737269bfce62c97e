// Nearest place on a sampled curve, beside nanoflann with one neighbour and with the source's
// hundred, in one run on one core. Times are processor time of this thread.
//
//     bench_curve [--figures FOLDER]   also draws Figures 47 to 49 of docs/algorithms

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "core/base/random.h"
#include "core/control/curve_tracker.h"
#include "core/stimulus/spatial_trajectory.h"
#include "tests/support/neighbour_method.h"

namespace {

using Eigen::Vector3d;
using haptrial::RandomStream;
using haptrial::control::CurvePlace;
using haptrial::control::CurveTracker;
using haptrial::control::SampledCurve;
using Points = std::vector<Vector3d>;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The first path of the shipped study in `count` points.
Points study_curve(std::size_t count) {
  RandomStream random(1, "trajectory");
  const haptrial::stimulus::SpatialTrajectory path({}, random);
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    points[i] = path.at(share * path.duration()).position;
  }
  points.back() = path.points().back();
  return points;
}

/// A knot in space that passes close to itself many times, ten times as long.
Points tangled_curve(std::size_t count) {
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    points[i] = {0.05 * std::sin(7.0 * a + 0.3), 0.03 * std::sin(9.0 * a),
                 0.04 * std::cos(8.0 * a)};
  }
  return points;
}

/// Every millisecond along the curve at 1.6 cm/s, up to 2 mm beside it, with an encoder's steps.
Points probe_path(const SampledCurve& curve) {
  RandomStream random(2, "probe");
  Points path;
  const double a = random.uniform(0.0, 6.0);
  for (double arc = 0.0; arc < std::min(curve.length(), 0.32); arc += 1.6e-5) {
    const double t = arc / 0.016;
    const Vector3d aside(1e-3 * std::sin(5.0 * t + a), 1e-3 * std::sin(3.0 * t),
                         1e-3 * std::cos(7.0 * t));
    path.push_back(1e-5 * ((curve.at(arc).position + aside) / 1e-5).array().round().matrix());
  }
  return path;
}

Points points_in_box(const Points& curve, std::size_t count) {
  Vector3d low = curve.front();
  Vector3d high = curve.front();
  for (const Vector3d& p : curve) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low.array() -= 0.01;
  high.array() += 0.01;
  RandomStream random(3, "box");
  Points points(count);
  for (Vector3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = random.uniform(low[axis], high[axis]);
    }
  }
  return points;
}

struct Cloud {
  const Points* points;
  std::size_t kdtree_get_point_count() const { return points->size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return (*points)[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>,
                                                   Cloud, 3, std::uint32_t>;

constexpr double kWeight = 0.01;  // the source's arc penalty of 1, with distances in centimetres

/// The source's method over nanoflann.
class Peer {
 public:
  explicit Peer(const Points& points)
      : method_(points), cloud_{&method_.points()}, tree_(3, cloud_, {10}) {
    tree_.buildIndex();
  }
  double one(const Vector3d& p) {
    std::uint32_t index = 0;
    double square = 0.0;
    tree_.knnSearch(p.data(), 1, &index, &square);
    return square;
  }
  CurvePlace search(const Vector3d& p, std::size_t n, double weight) {
    indices_.resize(n);
    squares_.resize(n);
    indices_.resize(tree_.knnSearch(p.data(), n, indices_.data(), squares_.data()));
    const CurvePlace place = method_.place(p, indices_, before_, weight);
    before_ = place.arc;
    return place;
  }
  void forget() { before_.reset(); }

 private:
  haptrial::test::NeighbourMethod method_;
  Cloud cloud_;
  KdTree tree_;
  std::vector<std::uint32_t> indices_;
  std::vector<double> squares_;
  std::optional<double> before_;
};

struct Cost {
  double mean{0.0};   // [us]
  double worst{0.0};  // of single queries [us]
};

double checksum = 0.0;

/// The fastest of five runs over all queries, and the slowest query, each at its fastest of three:
/// what other programs take from the caches is no query's own.
Cost cost(const Points& queries, const std::function<void()>& begin,
          const std::function<double(const Vector3d&)>& query) {
  std::vector<double> means;
  for (int run = 0; run < 5; ++run) {
    begin();
    const double start = now();
    for (const Vector3d& p : queries) {
      checksum += query(p);
    }
    means.push_back(1e6 * (now() - start) / static_cast<double>(queries.size()));
  }
  std::sort(means.begin(), means.end());
  std::vector<double> single(queries.size(), 1e9);
  for (int run = 0; run < 3; ++run) {
    begin();
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const double start = now();
      checksum += query(queries[i]);
      single[i] = std::min(single[i], 1e6 * (now() - start));
    }
  }
  return {means[0], *std::max_element(single.begin(), single.end())};
}

struct Row {
  std::string name;
  Cost path, box;
};

void print(const Row& row, const Row& peer) {
  std::printf("| %-42s | %8.3f | %8.2f | %8.3f | %8.1f | %6.0f |\n", row.name.c_str(),
              row.path.mean, row.path.worst, row.box.mean, row.box.worst,
              peer.path.mean / row.path.mean);
}

void measure(const char* name, const Points& points) {
  const double start = now();
  const SampledCurve curve(points);
  const double built = now() - start;
  const Points path = probe_path(curve);
  const Points box = points_in_box(points, 2000);
  CurveTracker tracker(curve);
  const auto nothing = [] {};
  const auto to_start = [&] { tracker.start(path.front()); };
  Row follow{"followed along the arc",
             cost(path, to_start, [&](const Vector3d& p) { return tracker.follow(p).arc; }),
             {}};
  const auto whole = [&](const Vector3d& p) { return curve.nearest(p).arc; };
  const Row nearest{"nearest of the whole curve", cost(path, nothing, whole),
                    cost(box, nothing, whole)};
  follow.box = nearest.box;  // a jump is a start, and a start searches the whole curve
  Peer peer(points);
  const auto one = [&](const Vector3d& p) { return peer.one(p); };
  const Row single{"nanoflann, 1 neighbour (a point, no segment)", cost(path, nothing, one),
                   cost(box, nothing, one)};
  const auto forget = [&] { peer.forget(); };
  const auto hundred = [&](const Vector3d& p) { return peer.search(p, 100, kWeight).arc; };
  const Row source{"nanoflann, the source's 100 neighbours", cost(path, forget, hundred),
                   cost(box, forget, hundred)};
  std::printf("\n%s, %zu points, %.2f m (built in %.2f ms)\n", name, points.size(), curve.length(),
              1e3 * built);
  std::printf("| µs a query | 1 kHz path | worst | in the box | worst | source / this |\n");
  std::printf("| --- | --- | --- | --- | --- | --- |\n");
  for (const Row* row : std::initializer_list<const Row*>{&follow, &nearest, &single, &source}) {
    print(*row, source);
  }
}

using haptrial::analysis::Figure;
using haptrial::analysis::Mark;
using haptrial::analysis::Series;

/// Two strands that cross and come near each other, and a hand that strays up to 4 mm.
Figure continuity() {
  Points points;
  for (int i = 0; i < 2000; ++i) {
    const double a = 2.0 * M_PI * i / 2000.0;
    points.push_back({0.05 * std::sin(2.0 * a), 0.0, 0.03 * std::sin(3.0 * a + 0.5)});
  }
  const SampledCurve curve(points);
  CurveTracker tracker(curve);
  const char* solid = "solid";
  Series line{"curve", Mark::kLine, {"#d55e00", solid, 0, 2.5}};
  for (const Vector3d& p : points) {
    line.x.push_back(100.0 * p.x());
    line.y.push_back(100.0 * p.z());
  }
  Series hand{"tool", Mark::kLine, {"#009e73", solid, 0, 2.0}};
  Series pairs{"tool to its place", Mark::kSegments, {"#1a1a1a", solid, 0, 0.8}};
  Series strand{"here another strand is nearer", Mark::kPoints, {"#0072b2", solid, 6, 1.5, 0.9}};
  for (int i = 0; i < 20000; ++i) {
    const double arc = curve.length() * i / 20000.0;
    const Vector3d tool = curve.at(arc).position + Vector3d(0.004 * std::sin(260.0 * arc), 0.0,
                                                            0.004 * std::cos(330.0 * arc + 1.0));
    const CurvePlace& place = tracker.follow(tool);
    if (i % 20 == 0) {
      hand.x.push_back(100.0 * tool.x());
      hand.y.push_back(100.0 * tool.z());
    }
    if (i % 80 == 0) {
      pairs.x.push_back(hand.x.back());
      pairs.y.push_back(hand.y.back());
      pairs.x2.push_back(100.0 * place.position.x());
      pairs.y2.push_back(100.0 * place.position.z());
      if (std::abs(curve.nearest(tool).arc - place.arc) > 0.01) {
        strand.x.push_back(hand.x.back());
        strand.y.push_back(hand.y.back());
      }
    }
  }
  Figure figure;
  figure.name = "curve-continuity";
  figure.title = "The place stays on its strand";
  figure.x_label = "x [cm]";
  figure.y_label = "z [cm]";
  figure.series = {pairs, line, hand, strand};
  figure.equal_scale = true;
  figure.height = 0.75;
  return figure;
}

Figure by_points() {
  Series ours{"followed along the arc", Mark::kLine, {"#0072b2", "solid", 0, 2.5}};
  Series whole{"nearest of the whole curve", Mark::kLine, {"#009e73", "(9,4)", 0, 2.0}};
  Series source{"the source's 100 neighbours", Mark::kLine, {"#d55e00", "(9,4,2,4)", 0, 2.5}};
  Figure figure;
  double place = 0.0;
  for (const std::size_t count : {2000u, 20000u, 200000u, 2000000u}) {
    const Points points = study_curve(count);
    const SampledCurve curve(points);
    const Points path = probe_path(curve);
    CurveTracker tracker(curve);
    Peer peer(points);
    const auto add = [&](Series& series, double mean) {
      series.x.push_back(place);
      series.y.push_back(mean);
    };
    add(ours, cost(
                  path, [&] { tracker.start(path.front()); },
                  [&](const Vector3d& p) { return tracker.follow(p).arc; })
                  .mean);
    add(whole, cost(
                   path, [] {}, [&](const Vector3d& p) { return curve.nearest(p).arc; })
                   .mean);
    add(source, cost(
                    path, [&] { peer.forget(); },
                    [&](const Vector3d& p) { return peer.search(p, 100, kWeight).arc; })
                    .mean);
    figure.x_names.emplace_back(place, std::to_string(count));
    std::printf("%zu points: %.3f, %.3f, %.2f us\n", count, ours.y.back(), whole.y.back(),
                source.y.back());
    place += 1.0;
  }
  figure.name = "curve-points";
  figure.title = "Time of a query over the number of points";
  figure.x_label = "Points of the curve";
  figure.y_label = "Time of a query [µs]";
  figure.series = {ours, whole, source};
  return figure;
}

Figure by_neighbours() {
  const Points points = study_curve(2000);
  const SampledCurve curve(points);
  const Points path = probe_path(curve);
  CurveTracker tracker(curve);
  Peer peer(points);
  Series ours{"followed along the arc, exact", Mark::kLine, {"#0072b2", "solid", 0, 2.5}};
  Series source{"the source's N neighbours", Mark::kLine, {"#d55e00", "(9,4,2,4)", 0, 2.5}};
  const double own = cost(
                         path, [&] { tracker.start(path.front()); },
                         [&](const Vector3d& p) { return tracker.follow(p).arc; })
                         .mean;
  for (const std::size_t n : {1u, 10u, 25u, 50u, 100u, 150u, 200u}) {
    source.x.push_back(static_cast<double>(n));
    source.y.push_back(cost(
                           path, [&] { peer.forget(); },
                           [&](const Vector3d& p) { return peer.search(p, n, kWeight).arc; })
                           .mean);
    ours.x.push_back(static_cast<double>(n));
    ours.y.push_back(own);
    std::printf("N = %zu: %.3f us, ours %.3f\n", n, source.y.back(), own);
  }
  Figure figure;
  figure.name = "curve-neighbours";
  figure.title = "Time of a query over the number of neighbours, 2000 points";
  figure.x_label = "Neighbours that the source's method looks at";
  figure.y_label = "Time of a query [µs]";
  figure.series = {ours, source};
  return figure;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--figures") == 0) {
    haptrial::analysis::draw_figures({continuity(), by_points(), by_neighbours()}, argv[2]);
    return 0;
  }
  for (const std::size_t count : {std::size_t{2000}, std::size_t{2000000}}) {
    measure("The study's first path", study_curve(count));
  }
  for (const std::size_t count : {std::size_t{2000}, std::size_t{2000000}}) {
    measure("A tangled curve in space", tangled_curve(count));
  }
  std::printf("\n(checksum %g)\n", checksum);
  return 0;
}
