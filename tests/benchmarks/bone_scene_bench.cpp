// Frames of a bone off screen at 1280 x 720, against the aims: 15 frames a second with 200,000
// triangles, and a time that does not grow with the bone where little changes. With the picture of
// what rests drawn anew in every frame, and kept.
// bench_bone_scene [BONE.nrrd]; without one a ball with holes, at four resolutions.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "core/base/random.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/surface/surface.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/gl/offscreen.h"

namespace {

using namespace haptrial;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kFrames = 15;  // of each kind

/// Processor time of all threads of this process: the cost of a frame, whatever else the machine
/// does.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A frame, or the median of some.
struct Cost {
  double time{0.0};       // [s]
  double processor{0.0};  // [s]
};

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

/// @param prepare  what comes before a frame and does not count, by the frame's number
template <class Prepare, class Draw>
Cost measure(Prepare&& prepare, Draw&& draw) {
  std::vector<double> times;
  std::vector<double> processor;
  for (int i = 0; i < kFrames; ++i) {
    prepare(i);
    const double start = seconds();
    const double processor_start = processor_seconds();
    draw();
    times.push_back(seconds() - start);
    processor.push_back(processor_seconds() - processor_start);
  }
  return {median(times), median(processor)};
}

/// A ball takes what it meets; its radius in voxels. @returns voxels
int drill(bone::BoneVolume& volume, const Eigen::Vector3d& centre, int reach) {
  const geometry::VoxelGrid& grid = volume.grid();
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

/// A scene of one bone and a burr.
class Stage {
 public:
  Stage(const bone::BoneModel& model, bool kept)
      : volume_(model),
        box_(box_of(model.grid)),
        context_(kWidth, kHeight),
        scene_(context_.gl(), style_of(kept), model.structures, nullptr) {
    frame_.camera =
        render::looking_at(box_, {-1.0, 0.2, 0.1}, Eigen::Vector3d::UnitZ(), 16.0 / 9.0);
    frame_.bones = {{0, &volume_, Eigen::Isometry3d::Identity()}};
    frame_.meshes.push_back(
        {std::make_shared<geometry::Mesh>(render::burr_mesh(0.006, 0.0024, 0.09)),
         Eigen::Isometry3d::Identity()});
    frame_.meshes.back().casts = render::burr_shadow(0.006, 0.0024, 0.09);
    draw();
  }
  Cost moving() {
    const auto go_round = [this](int) {
      Camera& camera = frame_.camera;
      const Eigen::AngleAxisd turn(0.002, camera.up.normalized());
      camera.eye = camera.target + turn * (camera.eye - camera.target);
    };
    return measure(go_round, [&] { draw(); });
  }
  Cost resting() {
    for (int i = 0; i < 3; ++i) {
      draw();  // the visibility pass comes to its end
    }
    return measure([&](int i) { frame_.meshes[0].pose.translation() = burr_at(i); },
                   [&] { draw(); });
  }
  /// A burr of 6 mm that goes on by 0.3 mm in a frame: the finer the voxels, the more of them.
  Cost drilling() {
    return drilling(static_cast<int>(0.003 / volume_.grid().spacing),
                    [&](int i) { return burr_at(i); });
  }
  /// A burr of 18 voxels that goes on by one: as much changes, whatever the bone.
  Cost drilling_voxels() {
    const double voxel = volume_.grid().spacing;
    const Eigen::Vector3d out = Eigen::Vector3d(-0.8, 0.0, 0.6);
    return drilling(9, [&](int i) {
      return Eigen::Vector3d(box_.center() + (0.024 - 3 * voxel) * out +
                             (i - kFrames / 2) * voxel * Eigen::Vector3d::UnitY());
    });
  }
  Cost reading() {
    return measure([](int) {}, [&] { context_.read(); });
  }
  double voxels() const { return voxels_; }  // taken in a frame of the last drilling
  const render::BoneFrameFigures& figures() const { return scene_.figures(); }

 private:
  static Eigen::AlignedBox3d box_of(const geometry::VoxelGrid& grid) {
    return {grid.centre(0, 0, 0), grid.centre(grid.last())};
  }
  static render::BoneStyle style_of(bool kept) {
    render::BoneStyle style;
    style.kept_layer = kept;
    return style;
  }
  Eigen::Vector3d burr_at(int i) const {
    return box_.center() + Eigen::Vector3d(-0.45 * box_.sizes().x(), 0.0003 * i, 0.0);
  }
  template <class BurrAt>
  Cost drilling(int reach, BurrAt&& at) {
    int taken = 0;
    const Cost cost = measure(
        [&](int i) {
          frame_.meshes[0].pose.translation() = at(i);
          taken += drill(volume_, at(i), reach);
        },
        [&] { draw(); });
    voxels_ = static_cast<double>(taken) / kFrames;
    return cost;
  }
  void draw() {
    scene_.draw(frame_, kWidth, kHeight);
    context_.gl().finish();
  }

  bone::BoneVolume volume_;
  Eigen::AlignedBox3d box_;
  render::OffscreenContext context_;
  render::BoneScene scene_;
  render::BoneFrame frame_;
  double voxels_{0.0};
};

double load() {
  double average = 0.0;
  return getloadavg(&average, 1) == 1 ? average : -1.0;
}

void compare(const bone::BoneModel& model) {
  const auto print = [](const Cost& cost) {
    fmt::print(" {:6.1f} {:5.1f}", 1e3 * cost.time, 1e3 * cost.processor);
  };
  for (const bool kept : {false, true}) {
    Stage stage(model, kept);
    const Cost moving = stage.moving();
    const Cost resting = stage.resting();
    fmt::print("{:8} {:5}", stage.figures().triangles, kept ? "yes" : "no");
    print(moving);
    print(resting);
    for (const bool same_voxels : {true, false}) {
      print(same_voxels ? stage.drilling_voxels() : stage.drilling());
      fmt::print(" {:6.0f} {:7} {:7}", stage.voxels(), stage.figures().drawn,
                 stage.figures().pixels);
    }
    print(stage.reading());
    fmt::print(" {:5.1f}\n", load());
  }
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print(
      "{} x {} pixels; medians of {} frames: time and processor time of all threads [ms]; of "
      "drilling, voxels taken, triangles and pixels of bone drawn\n"
      "{:>8} {:>5} {:>12} {:>12} {:>35} {:>35} {:>12} {:>5}\n",
      kWidth, kHeight, kFrames, "tri", "kept", "moving", "resting", "burr of 18 voxels", "of 6 mm",
      "reading", "load");
  if (argc > 1) {
    compare(bone::load_bone(argv[1]));
    return 0;
  }
  for (const int size : {64, 120, 180, 250}) {
    compare(holed_ball(size));
  }
  return 0;
}
