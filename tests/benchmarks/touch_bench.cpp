// Feel of a soft block with and without a lump, and the cost of a tick, as tables:
//   bench_touch felt > touch.dat; gnuplot tests/benchmarks/touch.gp draws deformable-touch.svg
//   bench_touch ticks
//   bench_touch moving: ticks of a body of springs
//   bench_touch rates: the same at rates of its own, and how far that is felt from the loop's
//   bench_touch implicit: springs and elements by implicit steps of 4 ms, in one run
//   bench_touch live: the same with a thread beside the real clock

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "core/deformable/elements/static_solver.h"
#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/moving_touch.h"
#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/two_rate_touch.h"
#include "core/geometry/mesh/procedural.h"

namespace {

using namespace haptrial::deformable;
using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kTop = 0.012;
constexpr double kRadius = 0.005;
constexpr double kTick = 0.001;  // [s]

SharedHapticMesh block(int cells) {
  FeltSides sides;
  sides.felt = {BodySide::kTop};
  return std::make_shared<const HapticMesh>(
      felt_block({0.048, 0.024, 0.048}, cells, sides, "block"));
}

Tissue tissue_with(double depth) {
  Tissue tissue{15e3, 0.45, 1000.0, {}};
  if (depth > 0.0) {
    tissue.inclusions = {{"lump", {0.010, kTop - depth - 0.005, 0.010}, 0.005, 300e3}};
  }
  return tissue;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Processor time of this thread, so that other work on the machine does not count [µs].
double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// The ball's way over the block, 0 to 2 mm deep.
Vector3d wandering(double t) {
  return {0.012 * std::sin(t), kTop + kRadius - 0.001 - 0.001 * std::sin(1.7 * t),
          0.012 * std::cos(0.8 * t)};
}

SharedMovingBody springs(int cells) {
  const auto mesh = block(cells);
  const double energy = 15e3 * std::pow(mesh->spacing, 3);
  return prepared(mesh, SpringTissue{{0.5 * energy, 0.2 * energy, energy}, nullptr, 1000.0, 20.0});
}

/// Force under a ball that goes down over the lump, a block for each depth of it.
void felt() {
  for (const double depth : {0.0, 0.005, 0.003, 0.001}) {
    const auto body = prepared(block(16), tissue_with(depth));
    BallTouch touch(body, {kRadius, 1e6, {}});
    const Vector3d over(0.010, kTop + kRadius, 0.010);
    touch.start(over + Vector3d(0.0, 0.001, 0.0));
    fmt::print("# depth of the lump {} mm: ball in the block [mm], force [N]\n", 1e3 * depth);
    for (int i = 0; i <= 60; ++i) {
      const double in = 5e-5 * i;
      const auto& contact = touch.tick(over - Vector3d(0.0, in, 0.0), kTick);
      if (touch.counts().inverted == 0) {
        fmt::print("{:.3f} {:.5f}\n", 1e3 * in, contact.force.y());
      }
    }
    fmt::print("\n\n");
  }
}

const Vector3d kHalfAxes(0.024, 0.019, 0.0145);  // of an ellipsoid [m]

/// 13,000 tetrahedra that are touched all over but for what holds them.
SharedHapticMesh ellipsoid() {
  auto surface = haptrial::geometry::make_sphere(1.0, 20);
  for (Vector3d& vertex : surface.vertices) {
    vertex = vertex.cwiseProduct(kHalfAxes);
  }
  return std::make_shared<const HapticMesh>(felt_solid(surface, 22, {}, "ellipsoid"));
}

/// The ball's way round the upper half of the ellipsoid, 0 to 2 mm deep.
Vector3d round_ellipsoid(double t) {
  const double down = 0.6 + 0.5 * std::sin(0.8 * t);
  const Vector3d unit(std::sin(down) * std::cos(t), std::cos(down), std::sin(down) * std::sin(t));
  const Vector3d normal = unit.cwiseQuotient(kHalfAxes).normalized();
  const double depth = 0.001 + 0.001 * std::sin(1.7 * t);
  return unit.cwiseProduct(kHalfAxes) + (kRadius - depth) * normal;
}

template <class Route>
void ticks_of(const std::string& name, const SharedHapticMesh& mesh, const Tissue& tissue,
              Route way) {
  const auto start = Clock::now();
  const Compliance made(mesh, tissue);
  const double taken = seconds_since(start);
  const auto body = prepared(mesh, tissue);
  BallTouch touch(body, {kRadius, 5000.0, {0.3, 0.2}});
  touch.start(way(0.0));
  std::vector<double> times;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d tool = way(2e-3 * i);
    const double begin = thread_time();
    touch.tick(tool, kTick);
    times.push_back(thread_time() - begin);
  }
  std::sort(times.begin(), times.end());
  fmt::print("{} {} {} {} {:.2f} {:.1f} {:.1f} {:.1f} {:.1f} {} {}\n", name,
             mesh->tets.tetrahedra.size(), mesh->tets.vertices.size(), body->touched(), taken,
             1e-6 * compliance_memory(*mesh).kept, times[10000], times[19980], times.back(),
             touch.counts().unsettled, touch.counts().crowded);
}

void ticks() {
  fmt::print(
      "body tetrahedra vertices touched prepared_s kept_MB median_us p999_us worst_us unsettled "
      "crowded\n");
  for (const int cells : {8, 12, 16, 20}) {
    ticks_of(fmt::format("block-{}", cells), block(cells), tissue_with(0.003), wandering);
  }
  ticks_of("ellipsoid", ellipsoid(), tissue_with(0.0), round_ellipsoid);
}

/// A ball that wanders over a block of springs, 0 to 2 mm deep.
void moving() {
  fmt::print("cells vertices tetrahedra steps stable_ms median_us p999_us worst_us cut\n");
  for (const int cells : {8, 12, 16}) {
    const auto body = springs(cells);
    const auto& mesh = body->mesh;
    MovingTouch touch(body, {kRadius, 5000.0, {0.3, 0.2}}, kTick);
    touch.start({0.0, kTop + kRadius + 0.001, 0.0});
    std::vector<double> times;
    for (int i = 0; i < 20000; ++i) {
      const Vector3d tool = wandering(2e-3 * i);
      const double begin = thread_time();
      touch.tick(tool, kTick);
      times.push_back(thread_time() - begin);
    }
    std::sort(times.begin(), times.end());
    fmt::print("{} {} {} {} {:.3f} {:.1f} {:.1f} {:.1f} {}\n", cells, mesh->tets.vertices.size(),
               body->springs.tetrahedra.size(), touch.steps(), 1e3 * body->stable_step,
               times[10000], times[19980], times.back(), touch.counts().limited);
  }
}

/// How far a body is from where elements are at rest under the forces that it gets, as a share of
/// the farthest vertex's way.
double far_from_elements(const ElasticBody& elements, const MovingBody& body,
                         const MovingTouch& touch) {
  LoadCase load{"ball", {}, {}};
  for (const std::int32_t v : body.held) {
    load.holds.push_back({v, Vector3d::Zero()});
  }
  for (const VertexForce& each : touch.forces()) {
    load.forces.push_back({each.vertex, each.force.cast<double>()});
  }
  const Vectors rest = solve_static(elements, load).displacement;
  double far = 0.0, most = 0.0;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const Vector3d u = touch.motion().position(v) - body.mesh->tets.vertices[v];
    far = std::max(far, (u - rest[v]).norm());
    most = std::max(most, rest[v].norm());
  }
  return far / most;
}

/// A line of a body that is led for 4 s and then held for 1 s. @param period  of its ticks
void lead(const std::string& model, const SharedMovingBody& body, double period,
          const ElasticBody& elements) {
  MovingTouch touch(body, {kRadius, 5000.0, {}}, period);
  touch.start({0.0, kTop + kRadius + 0.001, 0.0});
  std::vector<double> times;
  const auto tick = [&](double t) {
    const double begin = thread_time();
    touch.tick(wandering(2.0 * t), period);
    times.push_back(thread_time() - begin);
  };
  double led = 0.0;
  while (led < 0.6) {
    tick(led += period);
  }
  const double moving = far_from_elements(elements, *body, touch);
  for (double t = 0.0; t < 1.0; t += period) {
    tick(led);
  }
  const double held = far_from_elements(elements, *body, touch);
  std::sort(times.begin(), times.end());
  const double median = times[times.size() / 2];
  const auto tets = static_cast<double>(body->mesh->tets.tetrahedra.size());
  fmt::print("{} {} {:.0f} {:.0f} {:.0f} {:.1f} {:.2f} {:.2f}\n", model, tets, 1.0 / period, median,
             times.back(), tets / median, 100.0 * moving, 100.0 * held);
}

void implicit_beside_springs() {
  fmt::print("model tetrahedra rate_Hz tick_median_us worst_us million_tets_s moving_% held_%\n");
  for (const int cells : {12, 16, 20}) {
    for (const double poisson : {0.3, 0.45}) {
      const SharedMovingBody elements =
          prepared(block(cells), ImplicitTissue{{15e3, poisson, 1000.0, {}}, 20.0}, 4.0 * kTick);
      lead(fmt::format("implicit-{}", poisson), elements, 4.0 * kTick, *elements->elements);
      if (poisson < 0.4) {
        lead("springs", springs(cells), kTick, *elements->elements);
      }
    }
  }
}

/// How far a body of its own rate is felt from one that moves on each tick.
struct Error {
  double sum{0.0}, size{0.0};
  std::vector<double> each;

  void add(const Vector3d& felt, const Vector3d& expected) {
    sum += (felt - expected).squaredNorm();
    size += expected.squaredNorm();
    each.push_back((felt - expected).norm());
  }
  double share() const { return std::sqrt(sum / size); }
  double p99() {
    std::sort(each.begin(), each.end());
    return each[each.size() * 99 / 100];
  }
};

void rates() {
  constexpr int kTicks = 6000, kFirst = 200;
  fmt::print("cells rate friction speed_mm_s rms_share p99_N rms_N cut cut_of_one tick_us\n");
  for (const int cells : {8, 12}) {
    const auto body = springs(cells);
    for (const int window : {2, 4, 8}) {
      const auto gives = prepared_compliance(body, window * kTick);
      for (const double friction : {0.0, 0.3}) {
        for (const double scale : {2e-3, 6e-3}) {
          const TouchOptions ball{kRadius, 5000.0, {friction, friction / 1.5}};
          MovingTouch one(body, ball, kTick);
          TwoRateTouch two(body, gives, ball, kTick, {window, false});
          one.start(wandering(0.0));
          two.start(wandering(0.0));
          Error error;
          std::vector<double> times;
          TouchCounts before_one, before_two;
          for (int i = 0; i < kTicks; ++i) {
            const Vector3d tool = wandering(scale * i);
            const Vector3d expected = one.tick(tool, kTick).force;
            const double begin = thread_time();
            const Vector3d felt = two.tick(tool, kTick).force;
            times.push_back(thread_time() - begin);
            const bool cut = one.counts().limited > before_one.limited ||
                             two.counts().limited > before_two.limited;
            if (i >= kFirst && !cut) {
              error.add(felt, expected);
            }
            before_one = one.counts();
            before_two = two.counts();
          }
          std::sort(times.begin(), times.end());
          fmt::print("{} {:.0f} {} {:.0f} {:.4f} {:.4f} {:.4f} {} {} {:.1f}\n", cells,
                     1.0 / (window * kTick), friction, 12.0 * scale / kTick, error.share(),
                     error.p99(), std::sqrt(error.size / static_cast<double>(error.each.size())),
                     before_two.limited, before_one.limited, times[times.size() / 2]);
        }
      }
    }
  }
}

/// Ticks on the real clock beside a thread that moves the body at 250 Hz.
void live() {
  constexpr int kWindow = 4, kTicks = 5000;
  fmt::print("cells tetrahedra median_us p999_us worst_us late_windows of\n");
  for (const int cells : {8, 12, 16}) {
    const auto body = springs(cells);
    TwoRateTouch touch(body, prepared_compliance(body, kWindow * kTick),
                       {kRadius, 5000.0, {0.3, 0.2}}, kTick, {kWindow, true});
    touch.start(wandering(0.0));
    std::vector<double> times;
    auto next = Clock::now();
    for (int i = 0; i < kTicks; ++i) {
      std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
      const double begin = thread_time();
      touch.tick(wandering(2e-3 * i), kTick);
      times.push_back(thread_time() - begin);
    }
    std::sort(times.begin(), times.end());
    fmt::print("{} {} {:.1f} {:.1f} {:.1f} {} {}\n", cells, body->springs.tetrahedra.size(),
               times[kTicks / 2], times[kTicks * 999 / 1000], times.back(), touch.late().size(),
               kTicks / kWindow);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "ticks";
  if (what == "felt") {
    felt();
  } else if (what == "moving") {
    moving();
  } else if (what == "rates") {
    rates();
  } else if (what == "implicit") {
    implicit_beside_springs();
  } else if (what == "live") {
    live();
  } else {
    ticks();
  }
}
