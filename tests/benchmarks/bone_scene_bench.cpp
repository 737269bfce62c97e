// Frames of a bone off screen at 1280 x 720, against the aims: 15 frames a second with 200,000
// triangles, and a time that does not grow with the bone where little changes.
// bench_bone_scene [BONE.nrrd]; without one a ball with holes, at three resolutions.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include "core/base/random.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/surface.h"
#include "core/render/bone_scene.h"
#include "core/render/offscreen.h"

namespace {

using namespace haptrial;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kFrames = 15;  // of each kind

/// Of all threads of this process: what a frame costs, whatever else the machine does.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// 50 mm across, with air cells of 2 to 4 mm.
bone::BoneModel holed_ball(int size) {
  bone::BoneModel model;
  model.name = "holed ball";
  model.source = "made by a benchmark";
  model.grid = {{size, size, size}, {0, 0, 0}, 0.05 / size};
  model.structures = {{"", {0, 0, 0}}, {"bone", {0.9, 0.87, 0.78}}};
  model.labels.assign(model.grid.count(), 0);
  RandomStream random(1, "holes");
  std::vector<Eigen::Vector4d> holes;
  for (int h = 0; h < 400; ++h) {
    holes.emplace_back(random.uniform(0, 0.05), random.uniform(0, 0.05), random.uniform(0, 0.05),
                       random.uniform(0.001, 0.002));
  }
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5 * model.grid.spacing * (size - 1));
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        const Eigen::Vector3d at = model.grid.centre(i, j, k);
        const bool bone = (at - middle).norm() < 0.024 &&
                          std::none_of(holes.begin(), holes.end(), [&](const Eigen::Vector4d& h) {
                            return (at - h.head<3>()).squaredNorm() < h.w() * h.w();
                          });
        model.labels[model.grid.index(i, j, k)] = bone ? 1 : 0;
      }
    }
  }
  return model;
}

double median(std::vector<double> times) {
  std::nth_element(times.begin(), times.begin() + static_cast<long>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

/// A burr of 6 mm takes what it meets. @returns voxels
int drill(bone::BoneVolume& volume, const Eigen::Vector3d& centre) {
  const geometry::VoxelGrid& grid = volume.grid();
  const int reach = static_cast<int>(0.003 / grid.spacing);
  const bone::Voxel middle = ((centre - grid.origin) / grid.spacing).array().round().cast<int>();
  int taken = 0;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const std::int32_t at = volume.address(bone::Voxel(middle + bone::Voxel(i, j, k)));
        if (at != 0 && i * i + j * j + k * k <= reach * reach) {
          taken += volume.take(at, 1.0F) > 0.0F;
        }
      }
    }
  }
  return taken;
}

void measure(const bone::BoneModel& model) {
  bone::BoneVolume volume(model);
  render::OffscreenContext context(kWidth, kHeight);
  render::BoneScene scene(context.gl(), {}, model.structures, nullptr);
  render::BoneFrame frame;
  const geometry::VoxelGrid& grid = model.grid;
  const Eigen::AlignedBox3d box(grid.centre(0, 0, 0),
                                grid.centre(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1));
  frame.camera = render::looking_at(box, {-1.0, 0.2, 0.1}, Eigen::Vector3d::UnitZ(), 16.0 / 9.0);
  frame.bones = {{0, &volume, Eigen::Isometry3d::Identity()}};
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(render::burr_mesh(0.006, 0.0024, 0.09)),
                          Eigen::Isometry3d::Identity()});
  const auto time = [&](bool until_read) {
    const double start = seconds();
    scene.draw(frame, kWidth, kHeight);
    context.gl().finish();
    if (until_read) {
      context.read();
    }
    return seconds() - start;
  };
  const double first = time(false);
  std::vector<double> moving, resting, drilling, reading, cost;
  for (int i = 0; i < kFrames; ++i) {
    frame.camera = render::orbited(frame.camera, 0.002, 0.0);
    const double start = processor_seconds();
    moving.push_back(time(false));
    cost.push_back(processor_seconds() - start);
  }
  for (int i = 0; i < kFrames; ++i) {
    time(false);  // the visibility pass comes to its end
  }
  for (int i = 0; i < kFrames; ++i) {
    frame.meshes[0].pose.translation().x() += 1e-5;
    resting.push_back(time(false));
    reading.push_back(time(true));
  }
  const std::size_t drawn = scene.figures().drawn;
  int taken = 0;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d centre =
        box.center() + Eigen::Vector3d(-0.45 * box.sizes().x(), 0.0003 * i, 0.0);
    frame.meshes[0].pose.translation() = centre;
    taken += drill(volume, centre);
    drilling.push_back(time(false));
  }
  const auto ms = [](const std::vector<double>& times) { return 1e3 * median(times); };
  fmt::print("{:8} {:8} {:8.0f} {:8.1f} {:8.1f} {:8.1f} {:8.1f} {:8.1f} {:8.0f} {:8.0f}\n",
             scene.figures().triangles, drawn, 1e3 * first, ms(moving), ms(cost), ms(resting),
             ms(drilling), ms(reading), 1.0 / median(moving), static_cast<double>(taken) / kFrames);
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{} x {} pixels; medians of {} frames [ms]\n", kWidth, kHeight, kFrames);
  fmt::print("{:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "tri", "drawn",
             "first", "moving", "cpu", "resting", "drilling", "+read", "moving/s", "voxels");
  if (argc > 1) {
    measure(bone::load_bone(argv[1]));
    return 0;
  }
  for (const int size : {60, 120, 180}) {
    measure(holed_ball(size));
  }
  return 0;
}
