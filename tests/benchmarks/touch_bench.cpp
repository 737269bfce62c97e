// What is felt of a soft block with and without a lump, and what a tick takes, as tables:
//   bench_touch felt > touch.dat; gnuplot tests/benchmarks/touch.gp draws deformable-touch.svg
//   bench_touch ticks
//   bench_touch moving: ticks of a body of springs

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "core/deformable/moving/moving_touch.h"
#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/prepared.h"

namespace {

using namespace haptrial::deformable;
using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kTop = 0.012;
constexpr double kRadius = 0.005;
constexpr double kTick = 0.001;  // [s]

SharedFeltMesh block(int cells) {
  FeltSides sides;
  sides.felt = {BodySide::kTop};
  return std::make_shared<const FeltMesh>(felt_block({0.048, 0.024, 0.048}, cells, sides, "block"));
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

/// Of this thread, so that other work on the machine does not count [µs].
double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
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

void ticks() {
  fmt::print("cells vertices touched prepared_s kept_MB median_us p999_us worst_us unsettled\n");
  for (const int cells : {8, 12, 16, 20}) {
    const auto mesh = block(cells);
    const auto start = Clock::now();
    const Compliance made(mesh, tissue_with(0.003));
    const double taken = seconds_since(start);
    const auto body = prepared(mesh, tissue_with(0.003));
    BallTouch touch(body, {kRadius, 5000.0, {0.3, 0.2}});
    touch.start({0.0, kTop + kRadius, 0.0});
    std::vector<double> times;
    for (int i = 0; i < 20000; ++i) {
      const double t = 2e-3 * i;
      const Vector3d tool(0.012 * std::sin(t), kTop + kRadius - 0.001 - 0.001 * std::sin(1.7 * t),
                          0.012 * std::cos(0.8 * t));
      const double begin = thread_time();
      touch.tick(tool, kTick);
      times.push_back(thread_time() - begin);
    }
    std::sort(times.begin(), times.end());
    fmt::print("{} {} {} {:.2f} {:.1f} {:.1f} {:.1f} {:.1f} {}\n", cells,
               mesh->tets.vertices.size(), body->touched(), taken,
               1e-6 * compliance_memory(*mesh).kept, times[10000], times[19980], times.back(),
               touch.counts().unsettled);
  }
}

/// A ball that wanders over a block of springs, 0 to 2 mm deep.
void moving() {
  fmt::print("cells vertices tetrahedra steps stable_ms median_us p999_us worst_us cut\n");
  for (const int cells : {8, 12, 16}) {
    const auto mesh = block(cells);
    const double energy = 15e3 * std::pow(mesh->spacing, 3);
    const auto body =
        prepared(mesh, SpringTissue{{0.5 * energy, 0.2 * energy, energy}, nullptr, 1000.0, 20.0});
    MovingTouch touch(body, {kRadius, 5000.0, {0.3, 0.2}}, kTick);
    touch.start({0.0, kTop + kRadius + 0.001, 0.0});
    std::vector<double> times;
    for (int i = 0; i < 20000; ++i) {
      const double t = 2e-3 * i;
      const Vector3d tool(0.012 * std::sin(t), kTop + kRadius - 0.001 - 0.001 * std::sin(1.7 * t),
                          0.012 * std::cos(0.8 * t));
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

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "ticks";
  what == "felt" ? felt() : what == "moving" ? moving() : ticks();
}
