// The bone simulator's tick on one core, and looking up a burr's samples in bricks, in OpenVDB and
// in a hash table of voxels.
//
//   bench_bone [BONE...]   also with bones from files (anything that `haptrial bone import` reads)
//
// Times are processor time of this thread: what another process took of the core is not in them.
// Source: Morris 2006, §3.2.2 and §3.2.3.

#include <fmt/core.h>
#include <time.h>

#ifdef HAPTRIAL_OPENVDB
#include <openvdb/openvdb.h>
#endif

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/random.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/drill/feel.h"
#include "tests/support/references/surface_samples.h"
#include "tests/support/solid_bone.h"

namespace {

using namespace haptrial;
using namespace haptrial::bone;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Times {
  double median;
  double high;  // 99.9th percentile
};

Times summary(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  return {1e6 * seconds[seconds.size() / 2], 1e6 * seconds[seconds.size() * 999 / 1000]};
}

BurrParameters seven_millimetres() {
  BurrParameters burr = default_burr(BurrKind::kCutting, 7e-3);
  burr.sample_spacing = 0.25e-3;
  return burr;
}

Quaterniond turned(int n) {
  return Quaterniond(Eigen::AngleAxisd(0.01 * n, Vector3d(1.0, 2.0, 3.0).normalized()));
}

constexpr int kFresh = 20;  // ticks until what was removed is put back: the burr stays immersed

/// Ticks on a path.
void print_tick(const std::string& what, const BoneModel& model, const BurrParameters& burr,
                InstructionSet set, const std::function<Vector3d(int)>& path) {
  constexpr int kTicks = 4000;
  Drill drill(burr, model.structures, set);
  const FeelParameters feel = default_feel(drill.burr().radius());
  BoneVolume bone(model);
  const BoneVolume untouched(model);
  std::vector<double> touches;
  std::vector<double> ticks;
  double samples = 0.0;
  double removed = 0.0;
  for (int n = 0; n < kTicks; ++n) {
    if (n % kFresh == 0) {
      for (std::int32_t at = BoneVolume::kBrickVoxels; at < bone.bricks() * 512; ++at) {
        if (bone.density(at) != untouched.density(at)) {
          bone.put(at, untouched.density(at));
        }
      }
    }
    const Vector3d tip = path(n);
    const double start = now();
    drill.begin_tick();
    const Contact contact = drill.touch(bone, tip, turned(n));
    const double touched = now();
    const Vector3d force = bone_force(contact, feel, burr, 1.0);
    const Removal removal = drill.remove(bone, contact, 1.0 + force.norm(), 1.0, 1e-3);
    const double end = now();
    touches.push_back(touched - start);
    ticks.push_back(end - start);
    samples += contact.samples;
    removed += removal.amount;
  }
  const Times touch = summary(touches);
  const Times tick = summary(ticks);
  const int all = drill.burr().samples();
  fmt::print(
      "{:<26} {:<8} {:>6} samples, {:>6.0f} immersed: touch {:5.1f}, tick {:5.1f} us, "
      "99.9 % {:5.1f}; {:4.0f} million samples/s (need at 1 kHz {:.1f}, at 1.5 kHz {:.1f}); "
      "{:.2f} voxels removed a tick\n",
      what, name_of(set), all, samples / kTicks, touch.median, tick.median, tick.high,
      all / tick.median, all * 1e-3, all * 1.5e-3, removed / kTicks);
}

/// Places in a model's bone, a slow walk among them.
std::function<Vector3d(int)> walk_in(const BoneModel& model) {
  std::vector<Vector3d> places;
  RandomStream random(1, "places");
  while (places.size() < 40) {
    const auto at = static_cast<std::size_t>(random.below(model.labels.size()));
    if (model.labels[at] != 0) {
      const auto i = static_cast<int>(at % static_cast<std::size_t>(model.grid.size[0]));
      const auto row = at / static_cast<std::size_t>(model.grid.size[0]);
      const auto j = static_cast<int>(row % static_cast<std::size_t>(model.grid.size[1]));
      const auto k = static_cast<int>(row / static_cast<std::size_t>(model.grid.size[1]));
      places.push_back(model.grid.centre(i, j, k));
    }
  }
  return [places](int n) {
    return Vector3d(places[static_cast<std::size_t>(n / kFresh) % places.size()] +
                    Vector3d::Constant(1e-6 * (n % kFresh)));
  };
}

/// The voxels of a burr's samples, pose by pose, computed beforehand: only the look-up is timed.
std::vector<Voxel> queries(const Burr& burr, const geometry::VoxelGrid& grid, int poses) {
  std::vector<Voxel> all;
  RandomStream random(2, "poses");
  const Vector3d middle = grid.centre(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
  for (int n = 0; n < poses; ++n) {
    const Vector3d tip =
        middle + grid.spacing * Vector3d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0),
                                         random.uniform(-9.0, 9.0));
    const Eigen::Matrix3d turn = turned(17 * n).toRotationMatrix();
    for (std::int32_t s = 0; s < burr.samples(); ++s) {
      const Vector3d at = ((tip + turn * burr.position(s) - grid.origin) / grid.spacing);
      all.emplace_back((at.array() + 0.5).floor().cast<int>().matrix());
    }
  }
  return all;
}

struct Hash {
  std::size_t operator()(const Voxel& v) const {
    return (static_cast<std::size_t>(v.x()) * 73856093U) ^
           (static_cast<std::size_t>(v.y()) * 19349663U) ^
           (static_cast<std::size_t>(v.z()) * 83492791U);
  }
};

/// Nanoseconds a sample, the median of some runs; the count of immersed samples must agree.
double nanoseconds(std::size_t samples, std::int64_t expected,
                   const std::function<std::int64_t()>& run) {
  std::vector<double> seconds;
  for (int n = 0; n < 15; ++n) {
    const double start = now();
    const std::int64_t count = run();
    seconds.push_back(now() - start);
    if (count != expected) {
      fmt::print("DISAGREES: {} and {}\n", count, expected);
      std::exit(1);
    }
  }
  std::sort(seconds.begin(), seconds.end());
  return 1e9 * seconds[seconds.size() / 2] / static_cast<double>(samples);
}

void print_look_ups(const std::string& what, const BoneModel& model) {
  constexpr int kPoses = 40;
  const BoneVolume bone(model);
  const Burr burr(seven_millimetres());
  const std::vector<Voxel> all = queries(burr, model.grid, kPoses);
  std::unordered_map<Voxel, float, Hash> map;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < bone.bricks() * 512; ++at) {
    if (bone.density(at) > 0.0F) {
      map.emplace(bone.voxel_at(at), bone.density(at));
    }
  }
  std::int64_t expected = 0;
  for (const Voxel& voxel : all) {
    expected += map.contains(voxel);
  }
  const auto report = [&](const char* name, double ns) {
    fmt::print("  {:<44} {:6.2f} ns a sample\n", name, ns);
  };
  fmt::print("{}: {} look-ups of a 7 mm burr, {:.0f} % immersed\n", what, all.size(),
             100.0 * static_cast<double>(expected) / static_cast<double>(all.size()));
  const double table = nanoseconds(all.size(), expected, [&] {
    std::int64_t count = 0;
    for (const Voxel& voxel : all) {
      count += bone.density(voxel) > 0.0F;
    }
    return count;
  });
  report("bricks behind a table, one at a time", table);
  Drill drill(seven_millimetres(), {});
  std::int64_t felt = 0;
  const double kernel = nanoseconds(all.size(), 0, [&] {
    RandomStream random(2, "poses");
    const auto& grid = model.grid;
    const Vector3d middle = grid.centre(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
    felt = 0;
    for (int n = 0; n < kPoses; ++n) {
      const Vector3d tip =
          middle + grid.spacing * Vector3d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0),
                                           random.uniform(-9.0, 9.0));
      drill.begin_tick();
      felt += drill.touch(bone, tip, turned(17 * n)).samples;
    }
    return std::int64_t{0};
  });
  report("Drill::touch, all of it (places, look-up, sums)", kernel);
  report("hash table of voxels (std::unordered_map)", nanoseconds(all.size(), expected, [&] {
           std::int64_t count = 0;
           for (const Voxel& voxel : all) {
             const auto found = map.find(voxel);
             count += found != map.end() && found->second > 0.0F;
           }
           return count;
         }));
#ifdef HAPTRIAL_OPENVDB
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
  openvdb::FloatGrid::Accessor write = grid->getAccessor();
  for (const auto& [voxel, density] : map) {
    write.setValue(openvdb::Coord(voxel.x(), voxel.y(), voxel.z()), density);
  }
  openvdb::FloatGrid::ConstAccessor accessor = grid->getConstAccessor();
  const double vdb = nanoseconds(all.size(), expected, [&] {
    std::int64_t count = 0;
    for (const Voxel& voxel : all) {
      count += accessor.getValue(openvdb::Coord(voxel.x(), voxel.y(), voxel.z())) > 0.0F;
    }
    return count;
  });
  report("OpenVDB's cached accessor", vdb);
  fmt::print("  OpenVDB takes {:.1f} times as long as a look-up, {:.1f} times as long as a touch\n",
             vdb / table, vdb / kernel);
#endif
}

/// How many rays of the surface-sample method cost what the volume's samples do.
void print_rays(const BoneModel& flat) {
  BoneVolume bone(flat);
  for (const double share : {0.25, 1.0}) {
    const Vector3d tip(1e-4, 2e-4, 3.5e-3 - share * 7e-3);
    const auto median = [&](auto&& touch) {
      std::vector<double> seconds;
      for (int n = 0; n < 500; ++n) {
        const double start = now();
        touch(turned(n));
        seconds.push_back(now() - start);
      }
      return summary(seconds).median;
    };
    Drill drill(seven_millimetres(), {});
    const double volume = median([&](const Quaterniond& turn) {
      drill.begin_tick();
      drill.touch(bone, tip, turn);
    });
    SurfaceSamples rays(3.5e-3, 1000);
    const double thousand = median([&](const Quaterniond& turn) { rays.touch(bone, tip, turn); });
    fmt::print(
        "{:.0f} % of the diameter deep: touch {:.1f} us; {:.0f} rays of the surface-sample "
        "method take as long\n",
        100.0 * share, volume, 1000.0 * volume / thousand);
  }
}

}  // namespace

int main(int argc, char** argv) {
#ifdef HAPTRIAL_OPENVDB
  openvdb::initialize();
#endif
  const auto full = test::solid_bone(64, 0.5e-3, [](const Vector3d&) { return true; });
  const auto in_middle = [](int n) { return Vector3d::Constant(1e-6 * (n % kFresh)); };
  for (const InstructionSet set : available_instruction_sets()) {
    print_tick("7 mm, 0.5 mm, in whole", full, seven_millimetres(), set, in_middle);
  }
  const auto flat = test::flat_bone(64, 0.5e-3);
  for (const double diameter : {1e-3, 4e-3, 7e-3}) {
    print_tick(fmt::format("{} mm, 0.5 mm deep", diameter * 1e3), flat,
               default_burr(BurrKind::kCutting, diameter), best_instruction_set(),
               [=](int n) { return Vector3d(1e-6 * n, 0.0, 0.5 * diameter - 0.5e-3); });
  }
  print_rays(flat);
  print_look_ups("0.5 mm, 64 voxels cubed, full", full);
  for (int n = 1; n < argc; ++n) {
    const BoneModel model = load_bone(argv[n]);
    const std::string name = fmt::format("{} at {:.3f} mm", model.name, model.grid.spacing * 1e3);
    print_tick(name, model, seven_millimetres(), best_instruction_set(), walk_in(model));
    print_look_ups(name, model);
  }
  return 0;
}
