// Time of a tick of scenes, on one core; processor time of this thread.
//
//     bench_scene

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace {

using Eigen::Vector3d;
using namespace haptrial::scene;

const Vector3d kOrigin = Vector3d::Zero();

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Field field(const char* name, FieldKind kind) { return {name, std::move(kind)}; }

MatrixViscousParameters curl() {
  MatrixViscousParameters p;
  p.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  return p;
}

const std::vector<Field> kMixed{
    field("floor", SurfaceParameters{HalfSpace{{0.0, 0.01, 0.0}}}),
    field("ridges", GratingParameters{"floor"}),
    field("rough", TextureParameters{"floor"}),
    field("rubbing", FrictionParameters{"floor"}),
    field("box", SurfaceParameters{Box{kOrigin, {0.1, 0.1, 0.1}, {0.1, 0.2, 0.3}}, true}),
    field("bar", SurfaceParameters{Cylinder{kOrigin, {1.0, 0.0, 0.0}, 0.04, 0.1}, true}),
    field("curl", curl()),
    field("mass", InertiaParameters{}),
    field("noise", NoiseVibrationParameters{}),
    field("home", MoverParameters{}),
};

const std::vector<Field> kPlain{
    field("spring", SpringParameters{}),
    field("line", LineChannelParameters{}),
    field("axes", AxisChannelParameters{}),
    field("floor", SurfaceParameters{HalfSpace{{0.0, 0.01, 0.0}}}),
    field("rubbing", FrictionParameters{"floor"}),
    field("ball", SurfaceParameters{Sphere{kOrigin, 0.02}, true}),
    field("oil", ViscousParameters{}),
    field("curl", curl()),
    field("push", ConstantParameters{{1.0, 0.0, 0.0}}),
    field("key", ClickParameters{}),
};

void measure(const char* name, const std::vector<Field>& fields) {
  constexpr std::size_t kTicks = 20000;
  std::vector<haptrial::PointState> way(kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    way[i].position = {0.03 * std::sin(7.0 * t), 0.02 * std::sin(5.0 * t),
                       0.03 * std::cos(3.0 * t)};
    way[i].velocity = {0.21 * std::cos(7.0 * t), 0.10 * std::cos(5.0 * t),
                       -0.09 * std::sin(3.0 * t)};
  }
  Scene scene(fields, 1000.0);
  scene.switch_to(Scene::kAll);
  double best = 1e9;
  Vector3d sum = Vector3d::Zero();
  std::vector<double> single(kTicks, 1e9);
  for (int run = 0; run < 7; ++run) {
    const double start = now();
    for (const haptrial::PointState& hand : way) {
      sum += scene.force(hand);
    }
    best = std::min(best, (now() - start) / kTicks);
    for (std::size_t i = 0; i < kTicks; ++i) {
      const double begin = now();
      sum += scene.force(way[i]);
      single[i] = std::min(single[i], now() - begin);
    }
  }
  std::printf("| %-46s | %6.3f | %6.2f |\n", name, 1e6 * best,
              1e6 * *std::max_element(single.begin(), single.end()));
  if (!std::isfinite(sum.norm())) {
    std::printf("not finite\n");
  }
}

}  // namespace

int main() {
  std::printf("| µs a tick | mean of the best run | slowest tick with the clock's own time |\n");
  std::printf("| --- | --- | --- |\n");
  measure("ten fields: springs, channels, walls", kPlain);
  measure("ten fields: textures, noise, solids", kMixed);
  for (const Field& one : kMixed) {
    std::vector<Field> scene{one};
    if (!surface_of(one).empty()) {
      scene.push_back(kMixed.front());
    }
    measure(("  " + one.name + (scene.size() > 1 ? " on the floor" : "")).c_str(), scene);
  }
  return 0;
}
