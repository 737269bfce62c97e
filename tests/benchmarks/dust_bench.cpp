// Cost of dust, moving and at rest, and of a round of the sound's and the thickness's work. One
// core; processor time of this thread.
//
//     bench_dust                   the figures
//     bench_dust --picture FILE    instead, a pile in a drilled cavity that is cut open (.png)

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "core/bone/dust/dust.h"
#include "core/bone/model/thickness.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "core/sound/drill_sound.h"

namespace {

namespace bone = haptrial::bone;
namespace render = haptrial::render;
namespace sound = haptrial::sound;

constexpr double kEdge = 0.5e-3;  // of voxels and cells [m]

double seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
double time_of(const Work& work) {
  const double start = seconds();
  work();
  return seconds() - start;
}

bone::DustParameters upright() {
  bone::DustParameters p;
  p.up = Eigen::Vector3d::UnitZ();
  p.region = {Eigen::Vector3d::Constant(-0.05), Eigen::Vector3d::Constant(0.05)};
  return p;
}

template <class F>
bone::BoneVolume volume_of(const std::array<std::int32_t, 3>& size, F&& is_bone) {
  bone::BoneModel model;
  model.grid.size = size;
  model.grid.spacing = kEdge;
  model.grid.origin = -0.5 * kEdge * Eigen::Vector3d(size[0] - 1, size[1] - 1, size[2] - 1);
  model.structures.resize(2);
  model.structures[1].name = "bone";
  model.labels.resize(model.grid.count());
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        model.labels[model.grid.index(i, j, k)] = is_bone(model.grid.centre(i, j, k)) ? 1 : 0;
      }
    }
  }
  return bone::BoneVolume(model);
}

/// Fills 41 x 41 x 60 cells over a floor.
void fill(bone::Dust& dust) {
  for (int k = 0; k < 60; ++k) {
    for (int j = -20; j <= 20; ++j) {
      for (int i = -20; i <= 20; ++i) {
        dust.deposit({kEdge * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5), 0.0, dust.capacity()});
        dust.step(0.0);
      }
    }
  }
}

void falling_apart() {
  const bone::BoneVolume floor =
      volume_of({190, 190, 1}, [](const Eigen::Vector3d&) { return true; });
  const bone::DustBone bones[] = {{&floor}};
  bone::Dust dust(upright());
  dust.follow(bones);
  fill(dust);
  fmt::print("a block of {} cells falls apart\n", dust.cells());
  for (const int steps : {1, 29, 120}) {
    std::size_t looked_at = 0;
    const double taken = time_of([&] {
      for (int i = 0; i < steps; ++i) {
        looked_at += dust.active();
        dust.step(dust.step_time());
      }
    });
    fmt::print("  {:4} steps, {:7.0f} active cells, {:7.3f} ms a step, {:4.0f} ns an active cell\n",
               steps, static_cast<double>(looked_at) / steps, 1e3 * taken / steps,
               1e9 * taken / static_cast<double>(looked_at));
  }
}

/// Dust of a drill that takes 250 voxels a second, in rounds of 10 ms.
void drilling() {
  const bone::BoneVolume block = volume_of({96, 96, 60}, [](const Eigen::Vector3d& p) {
    return p.z() < 0.0 && (p - Eigen::Vector3d(0, 0, 2e-3)).norm() > 9e-3;
  });
  const bone::DustBone bones[] = {{&block}};
  bone::Dust dust(upright());
  constexpr int kRounds = 400;
  std::vector<double> taken;
  for (int round = 0; round < kRounds; ++round) {
    const double angle = 0.02 * round;
    const Eigen::Vector3d burr(4e-3 * std::cos(angle), 4e-3 * std::sin(angle), -2e-3);
    bone::DustTools tools;
    tools.tools[0] = {burr, Eigen::Vector3d::UnitZ(), 0.04, 2e-3, false};
    taken.push_back(time_of([&] {
      dust.follow(bones);
      dust.deposit({burr, 2e-3, 2.5});
      dust.place(tools);
      dust.step(0.01);
    }));
  }
  std::sort(taken.begin(), taken.end());
  fmt::print("while drilling, a round of 10 ms: median {:.2f} ms, 99 % {:.2f} ms; {} cells\n",
             1e3 * taken[kRounds / 2], 1e3 * taken[kRounds * 99 / 100], dust.cells());
}

void thickness_and_sound() {
  const bone::BoneVolume slab =
      volume_of({96, 96, 12}, [](const Eigen::Vector3d&) { return true; });
  std::vector<bone::Voxel> voxels;
  const Eigen::Vector3d burr(0, 0, 3e-3 + 1e-3);
  constexpr int kTimes = 200;
  double sum = 0.0;
  const double taken = time_of([&] {
    for (int i = 0; i < kTimes; ++i) {
      bone::surface_voxels_within(slab, burr, 2e-3, voxels);
      sum += bone::mean_thickness(slab, voxels).value_or(0.0);
    }
  });
  fmt::print("thickness under {} surface voxels: {:.0f} us ({:.2f} mm)\n", voxels.size(),
             1e6 * taken / kTimes, 1e3 * sum / kTimes);
  sound::DrillSound drill(sound::default_sound(), {}, 1);
  drill.set({sound::Burr::kCutting, 1.0, true, 1.0, 1e-3});
  float last = 0.0F;
  const double second = time_of([&] {
    for (int i = 0; i < 48'000; ++i) {
      last += drill.next();
    }
  });
  sound::DrillVibration vibration(sound::default_vibration(), 1.0, 1000.0, 1);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  constexpr int kTicks = 100'000;
  const double shaking = time_of([&] {
    for (int i = 0; i < kTicks; ++i) {
      force += vibration.tick({sound::Burr::kCutting, 1.0, true, 1.0, 1.0}, {});
    }
  });
  fmt::print("a second of sound: {:.1f} ms; a tick of vibration: {:.0f} ns ({:.1f}, {:.1f})\n",
             1e3 * second, 1e9 * shaking / kTicks, static_cast<double>(last), force.x());
}

/// A cavity that a burr has drilled, half full of its dust; the front half of the bone is left out
/// of the picture, not of the simulation.
void draw(const char* file) {
  const auto cavity = [](const Eigen::Vector3d& p) {
    return p.z() < 5e-3 && (p - Eigen::Vector3d(0, 0, 4e-3)).norm() > 8e-3 &&
           (p - Eigen::Vector3d(5e-3, 0, 3e-3)).norm() > 6e-3;
  };
  const bone::BoneVolume whole = volume_of({60, 40, 32}, cavity);
  const bone::BoneVolume half =
      volume_of({60, 40, 32}, [&](const Eigen::Vector3d& p) { return cavity(p) && p.y() > 0.0; });
  bone::Dust dust(upright());
  const bone::DustBone bones[] = {{&whole}};
  dust.follow(bones);
  for (int i = 0; i < 200; ++i) {
    dust.deposit({{-1.5e-3, 0.0, 4e-3}, 1e-3, 4.5});
    dust.step(0.02);
  }
  for (int i = 0; i < 1000 && dust.active() > 0; ++i) {
    dust.step(0.02);
  }
  std::vector<bone::DustQuad> quads;
  dust.quads(quads);
  render::BoneFrame frame;
  frame.bones.push_back({1, &half});
  for (const bone::DustQuad& quad : quads) {
    if (quad.position.y() > 0.0F) {
      frame.dust.push_back(quad);
    }
  }
  constexpr int kWidth = 900;
  constexpr int kHeight = 520;
  frame.camera = render::looking_at(
      {Eigen::Vector3d(-15e-3, -2e-3, -8e-3), Eigen::Vector3d(15e-3, 10e-3, 7e-3)},
      Eigen::Vector3d(0.25, -1.0, 0.45), Eigen::Vector3d::UnitZ(),
      static_cast<double>(kWidth) / kHeight);
  render::OffscreenContext context(kWidth, kHeight);
  render::BoneStyle style;
  style.dust = {0.98, 0.96, 0.90};
  style.hard_bone = {0.74, 0.55, 0.42};
  style.background_visibility = false;
  std::vector<bone::Structure> structures(2);
  structures[1].colour = {0.74, 0.55, 0.42};
  render::BoneScene scene(context.gl(), style, structures, nullptr);
  scene.draw(frame, kWidth, kHeight);
  render::write_png(file, context.read());
  fmt::print("wrote {}: {} cells of dust\n", file, quads.size());
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 3 && std::string_view(arguments[1]) == "--picture") {
    draw(arguments[2]);
    return 0;
  }
  falling_apart();
  drilling();
  thickness_and_sound();
  return 0;
}
