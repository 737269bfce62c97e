// How far a burr's force depends on the voxels: a burr drills the same bone at several spacings,
// and its force is held against a dense integration of the bone that is there.
//
//   bench_burr_spacing [DIAMETER]   in mm; 4
//
// Times are processor time of this thread; of three touches that do the same the least counts.

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/bone/drill/feel.h"
#include "tests/support/solid_bone.h"

namespace {

using namespace haptrial;
using namespace haptrial::bone;
using Eigen::Vector3d;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A voxel with nothing around.
bool is_alone(const BoneVolume& bone, const Voxel& voxel) {
  for (int axis = 0; axis < 3; ++axis) {
    if (bone.density(Voxel(voxel + Voxel::Unit(axis))) > 0.0F ||
        bone.density(Voxel(voxel - Voxel::Unit(axis))) > 0.0F) {
      return false;
    }
  }
  return true;
}

/// Volume and push of a ball in bone, by 2 million places in it. They lie in the cells of a
/// lattice, but unevenly: planes of them would lie in the voxels' faces, or beside.
/// @param first  of the places in their cells, along each axis  @param lone  with lone voxels
Contact dense(const BoneVolume& bone, const Vector3d& tip, double radius, double first = 0.5,
              bool lone = true) {
  const double step = radius / 80.0;
  constexpr int kReach = 80;
  Contact sum;
  Vector3d place = Vector3d::Constant(first);
  for (int k = -kReach; k < kReach; ++k) {
    for (int j = -kReach; j < kReach; ++j) {
      for (int i = -kReach; i < kReach; ++i) {
        place += Vector3d(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
        place.array() -= place.array().floor();
        const Vector3d p = step * (Vector3d(i, j, k) + place);
        const double length = p.norm();
        if (length > radius || length == 0.0) {
          continue;
        }
        const Eigen::Array3d at =
            ((tip + p - bone.grid().origin) / bone.grid().spacing).array() + 0.5;
        const Voxel voxel(at.floor().cast<int>().matrix());
        if (bone.density(voxel) > 0.0F && (lone || !is_alone(bone, voxel))) {
          ++sum.samples;
          sum.push -= p / length;
        }
      }
    }
  }
  const double each = step * step * step;
  sum.volume = each * sum.samples;
  sum.push *= each;
  return sum;
}

struct Row {
  double ratio, error, length_error, own_error, lone_error, jump, median, high;
  int samples, crumbs;
};

/// Strokes over flat bone with a hand that presses with about 2 N.
Row drill(double spacing, double diameter, bool follows) {
  constexpr double kWidth = 20e-3;
  const int size = 2 * static_cast<int>(0.5 * kWidth / spacing);
  BoneVolume bone(test::solid_bone(size, spacing, [](const Vector3d& p) {
    // Bone with air cells, some 3 mm wide.
    return p.z() < 3e-3 &&
           std::sin(p.x() / 5e-4) + std::sin(p.y() / 6e-4) + std::sin(p.z() / 4e-4) < 1.4;
  }));
  BurrParameters parameters = default_burr(BurrKind::kCutting, diameter);
  if (follows) {
    parameters = for_bone(parameters, spacing);
  }
  Drill burr(parameters, {});
  const double radius = burr.burr().radius();
  const FeelParameters feel = default_feel(radius);
  constexpr int kTicks = 12000;
  constexpr int kBetween = 150;
  std::vector<double> times;
  double z = 3e-3 + radius;
  double force_sum = 0.0, dense_sum = 0.0, squares = 0.0, lengths = 0.0, jump = 0.0, before = 0.0;
  double own = 0.0, lone = 0.0;
  for (int n = 0; n < kTicks; ++n) {
    const double t = 1e-3 * n;
    const Vector3d tip(3e-3 * std::sin(9.0 * t), 2e-3 * std::sin(1.1 * t), z);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4 + 0.1 * std::sin(t), Vector3d::UnitX()));
    const bool held = n % kBetween == 0;
    const Vector3d exact = held ? push_force(dense(bone, tip, radius), feel) : Vector3d::Zero();
    Contact contact;
    double touch = 1.0;  // the least of three, which do the same
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double start = now();
      burr.begin_tick();
      contact = burr.touch(bone, tip, turn);
      touch = std::min(touch, now() - start);
    }
    if (held) {
      own += (push_force(dense(bone, tip, radius, 0.123), feel) - exact).squaredNorm();
      lone += (push_force(dense(bone, tip, radius, 0.5, false), feel) - exact).squaredNorm();
    }
    const double start = now();
    const Vector3d force = push_force(contact, feel);
    burr.remove(bone, contact, force.norm(), 1.0, 1e-3);
    times.push_back(touch + now() - start);
    if (held) {
      force_sum += force.norm();
      dense_sum += exact.norm();
      squares += (force - exact).squaredNorm();
      lengths += (force.norm() - exact.norm()) * (force.norm() - exact.norm());
    }
    jump = std::max(jump, n > 0 ? std::abs(force.norm() - before) : 0.0);
    before = force.norm();
    z += 1e-5 * std::clamp(force.z() - 2.0, -3.0, 3.0);
  }
  int crumbs = 0;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < bone.bricks() * BoneVolume::kBrickVoxels;
       ++at) {
    crumbs += bone.density(at) > 0.0F && is_alone(bone, bone.voxel_at(at)) ? 1 : 0;
  }
  std::sort(times.begin(), times.end());
  constexpr int kHeld = kTicks / kBetween;
  return {force_sum / dense_sum,
          std::sqrt(squares / kHeld) / (dense_sum / kHeld),
          std::sqrt(lengths / kHeld) / (dense_sum / kHeld),
          std::sqrt(own / kHeld) / (dense_sum / kHeld),
          std::sqrt(lone / kHeld) / (dense_sum / kHeld),
          jump,
          1e6 * times[times.size() / 2],
          1e6 * times[times.size() * 999 / 1000],
          burr.burr().samples(),
          crumbs};
}

}  // namespace

int main(int argc, char** argv) {
  const double diameter = argc > 1 ? 1e-3 * std::atof(argv[1]) : 4e-3;
  fmt::print("{:.3g} mm, 12 s of strokes at 2 N\n", 1e3 * diameter);
  for (const bool follows : {false, true}) {
    for (const double spacing : {0.5e-3, 0.288e-3, 0.19e-3, 0.096e-3}) {
      const Row row = drill(spacing, diameter, follows);
      fmt::print(
          "{:<22} {:5.3f} mm {:>7} samples: force {:.3f} of dense, error {:4.1f} % ({:4.1f} % of "
          "its length; of the reference {:4.2f} %, by lone voxels {:4.2f} %), largest step "
          "{:.2f} N, lone voxels {:>5}; tick {:5.1f} us, 99.9 % {:5.1f} us\n",
          follows ? "samples follow" : "as before", 1e3 * spacing, row.samples, row.ratio,
          100.0 * row.error, 100.0 * row.length_error, 100.0 * row.own_error,
          100.0 * row.lone_error, row.jump, row.crumbs, row.median, row.high);
    }
  }
  return 0;
}
