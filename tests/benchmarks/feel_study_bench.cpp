// The volume of a burr sampled, beside its surface: how stiff a bone may be before a hand cannot
// rest on it, and how even the floor of a drilled trench is.
//
//   bench_feel_study [FOLDER]
//
// With a FOLDER the series behind the figures of docs/algorithms/bone-feel.md are written there.
// Nothing depends on the machine. Source: Morris 2006, §3.2.3.4 and §3.2.3.5 (Figures 5 and 6).

#include <fmt/core.h>
#include <fmt/os.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/drill/feel.h"
#include "tests/support/bone_press.h"
#include "tests/support/references/surface_samples.h"
#include "tests/support/solid_bone.h"

namespace {

using namespace haptrial::bone;
using namespace haptrial::test;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Folder = std::optional<std::filesystem::path>;

constexpr double kRadius = 2e-3;

std::string name_of(int rays) { return rays == 0 ? "volume" : fmt::format("rays-{}", rays); }

/// One of the methods over one bone; `rays` 0 is the burr's volume.
class Method {
 public:
  explicit Method(int rays) : drill_(default_burr(BurrKind::kDiamond, 2 * kRadius), {}) {
    if (rays > 0) {
      rays_.emplace(kRadius, rays);
    }
  }

  /// Gain 1: default_feel(), and about the same force for rays at half a millimetre.
  BoneForce force(const BoneVolume& bone, const Quaterniond& turn, double gain) {
    constexpr double kNoLimit = 40.0;
    if (rays_) {
      return [=, this, &bone](const Vector3d& tip) {
        return surface_force(rays_->touch(bone, tip, turn), 4e5 * gain / rays_->samples(),
                             kNoLimit);
      };
    }
    FeelParameters feel = default_feel(kRadius);
    feel.first_gain *= gain;
    feel.second_gain *= gain;
    feel.force_limit = kNoLimit;
    return [=, this, &bone](const Vector3d& tip) {
      drill_.begin_tick();
      return push_force(drill_.touch(bone, tip, turn), feel);
    };
  }

  /// Takes `rate` of every voxel that is reached, a second.
  void drill(BoneVolume& bone, const Vector3d& tip, const Quaterniond& turn, double rate,
             double dt) {
    if (rays_) {
      rays_->touch(bone, tip, turn);
      rays_->remove(bone, static_cast<float>(rate * dt));
      return;
    }
    drill_.begin_tick();
    const Contact contact = drill_.touch(bone, tip, turn);
    drill_.remove(bone, contact, rate / drill_.burr().parameters().removal_rate, 1.0, dt);
  }

 private:
  Drill drill_;
  std::optional<SurfaceSamples> rays_;
};

Quaterniond pose(int n) {
  return Quaterniond(Eigen::AngleAxisd(0.3 + 0.9 * n, Vector3d(1.0, 0.3 * n, 0.2).normalized()));
}

/// Stiffness against what is left of movement, the worst of eight poses, a hand without friction.
void write_rest(int rays, double press_force, const Folder& folder) {
  constexpr double kStill = 20e-6;
  const BoneVolume bone(flat_bone(48, 0.5e-3));
  Method method(rays);
  std::optional<fmt::ostream> out;
  if (folder) {
    out.emplace(fmt::output_file((*folder / fmt::format("rest-{}.dat", name_of(rays))).string()));
  }
  double usable = 0.0;
  bool calm = true;
  for (double gain = 0.3; gain < 12.0; gain *= 1.25) {
    double stiffness = 0.0;
    double worst = 0.0;
    constexpr int kPoses = 8;
    for (int n = 0; n < kPoses; ++n) {
      const BoneForce force = method.force(bone, pose(n), gain);
      stiffness += stiffness_at(force, kRadius, press_force) / kPoses;
      worst = std::max(worst,
                       press(force, Vector3d(1e-4, 2e-4, kRadius), {press_force, 0.0, 250.0}).way);
    }
    calm = calm && worst < kStill;
    usable = calm ? stiffness : usable;
    if (out) {
      out->print("{} {} {}\n", gain, stiffness * 1e-3, worst * 1e6);
    }
  }
  fmt::print("{:>9}  {:5.1f} N/mm at {} N with less than {:.0f} um of movement\n", name_of(rays),
             usable * 1e-3, press_force, kStill * 1e6);
}

/// The force at a constant depth while the tool is turned: what is not of the bone.
void print_evenness(int rays) {
  const BoneVolume bone(flat_bone(48, 0.5e-3));
  Method method(rays);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kPoses = 200;
  for (int n = 0; n < kPoses; ++n) {
    const double f =
        method.force(bone, pose(n), 1.0)(Vector3d(1e-4, 2e-4, kRadius - 0.5e-3)).norm();
    sum += f;
    squares += f * f;
  }
  const double mean = sum / kPoses;
  fmt::print("{:>9}  force 0.5 mm deep over poses: {:.2f} N, standard deviation {:.1f} %\n",
             name_of(rays), mean, 100.0 * std::sqrt(squares / kPoses - mean * mean) / mean);
}

/// A trench 0.8 mm deep, the tool fed along x at 5 mm/s: how deep the floor is below the surface.
void write_floor(int rays, const Folder& folder) {
  constexpr double kSpacing = 0.2e-3;
  constexpr double kDeep = 0.8e-3;
  constexpr double kSpeed = 5e-3;
  BoneVolume bone(flat_bone(60, kSpacing));
  Method method(rays);
  const Quaterniond lying(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3d::UnitX()));
  for (double x = -4e-3; x <= 4e-3; x += kSpeed * 1e-3) {
    method.drill(bone, Vector3d(x, 0.0, kRadius - kDeep), lying, 25.0, 1e-3);
  }
  std::optional<fmt::ostream> out;
  if (folder) {
    out.emplace(fmt::output_file((*folder / fmt::format("floor-{}.dat", name_of(rays))).string()));
  }
  const auto& grid = bone.grid();
  int left = 0;
  int swept = 0;
  double squares = 0.0;
  int columns = 0;
  for (int j = 0; j < grid.size[1]; ++j) {
    for (int i = 0; i < grid.size[0]; ++i) {
      const double x = grid.coordinate(0, i);
      const double y = grid.coordinate(1, j);
      if (std::abs(x) > 2.5e-3 || std::abs(y) > kRadius) {
        continue;
      }
      // The cylinder that the burr swept; air above z = 0.
      const double bottom = std::min(0.0, kRadius - kDeep - std::sqrt(kRadius * kRadius - y * y));
      int k = grid.size[2] / 2 - 1;
      while (k >= 0 && !(bone.density(Voxel(i, j, k)) > 0.0F)) {
        --k;
      }
      const double floor = grid.coordinate(2, k) + 0.5 * kSpacing;
      if (std::abs(y) < 1.4e-3) {
        squares += (floor - bottom) * (floor - bottom);
        ++columns;
      }
      if (out) {
        out->print("{} {} {}\n", x * 1e3, y * 1e3, floor * 1e3);
      }
      for (k = 0; k < grid.size[2] / 2; ++k) {
        if (grid.coordinate(2, k) > bottom + 0.5 * kSpacing) {
          ++swept;
          left += bone.density(Voxel(i, j, k)) > 0.0F;
        }
      }
    }
    if (out) {
      out->print("\n");
    }
  }
  fmt::print(
      "{:>9}  left of the {} voxels inside the swept trench: {} ({:.1f} %), floor {:.0f} um "
      "RMS off\n",
      name_of(rays), swept, left, 100.0 * left / swept, 1e6 * std::sqrt(squares / columns));
}

/// A plate of one voxel, 0.5 mm: the force against depth, where 3 N carry 0.5 mm of thick bone.
void write_plate(int rays, const Folder& folder) {
  constexpr double kForce = 3.0;
  const BoneVolume thick(flat_bone(48, 0.5e-3));
  const BoneVolume plate(
      solid_bone(48, 0.5e-3, [](const Vector3d& p) { return p.z() < 0.0 && p.z() > -0.5e-3; }));
  Method method(rays);
  const auto at = [](double depth) { return Vector3d(1e-4, 2e-4, kRadius - depth); };
  const auto force = [&](const BoneVolume& bone, double gain, double depth) {
    return method.force(bone, pose(1), gain)(at(depth)).norm();
  };
  double low = 0.01;
  double high = 20.0;
  for (int n = 0; n < 50; ++n) {
    const double middle = 0.5 * (low + high);
    (force(thick, middle, 0.5e-3) < kForce ? low : high) = middle;
  }
  std::optional<fmt::ostream> out;
  if (folder) {
    out.emplace(fmt::output_file((*folder / fmt::format("plate-{}.dat", name_of(rays))).string()));
  }
  double greatest = 0.0;
  for (double depth = 0.0; depth < 2.0 * kRadius; depth += 1e-5) {
    const double f = force(plate, low, depth);
    greatest = std::max(greatest, f);
    if (out) {
      out->print("{} {}\n", depth * 1e3, f);
    }
  }
  fmt::print("{:>9}  a plate of 0.5 mm carries {:.1f} N\n", name_of(rays), greatest);
}

/// Figure 6 as built, and the force against depth.
void write_mapping(const std::filesystem::path& folder) {
  auto out = fmt::output_file((folder / "mapping.dat").string());
  const FeelParameters feel = default_feel(kRadius);
  const BoneVolume bone(flat_bone(48, 0.5e-3));
  Drill drill(default_burr(BurrKind::kDiamond, 2 * kRadius), {});
  for (double depth = 0.0; depth <= 1.3e-3; depth += 5e-6) {
    drill.begin_tick();
    const Contact contact = drill.touch(bone, Vector3d(1e-4, 2e-4, kRadius - depth), pose(1));
    const double cap = std::numbers::pi * depth * depth * (kRadius - depth / 3.0);
    out.print("{} {} {} {} {}\n", depth * 1e3, contact.samples, contact.volume * 1e9,
              push_force(contact, feel).norm(), magnitude(cap, feel));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Folder folder = argc > 1 ? Folder(argv[1]) : std::nullopt;
  if (folder) {
    std::filesystem::create_directories(*folder);
    write_mapping(*folder);
  }
  const std::vector<int> methods{26, 56, 250, 0};
  for (const int rays : methods) {
    write_rest(rays, 3.0, folder);
  }
  for (const int rays : methods) {
    print_evenness(rays);
  }
  for (const int rays : methods) {
    write_plate(rays, folder);
  }
  for (const int rays : methods) {
    write_floor(rays, folder);
  }
  return 0;
}
