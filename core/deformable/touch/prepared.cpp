#include "core/deformable/touch/prepared.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/deformable/touch/ball_touch.h"

namespace haptrial::deformable {
namespace {

/// Memory that the machine can give to a program that asks now [bytes].
double free_memory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word) {
    if (double kilobytes = 0.0; word == "MemAvailable:" && file >> kilobytes) {
      return 1024.0 * kilobytes;
    }
  }
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct AnyMesh {
  SharedHapticMesh mesh;
  bool operator==(const AnyMesh& other) const {
    return mesh == other.mesh || same_mesh(*mesh, *other.mesh);
  }
};

/// The first of the meshes that are alike, so that the servo thread need not compare them.
SharedHapticMesh first_alike(const SharedHapticMesh& mesh) {
  static SharedCache<AnyMesh, HapticMesh> meshes(kMostPrepared);
  return meshes.get({mesh}, [&] { return mesh; });
}

}  // namespace

void check_memory(const HapticMesh& mesh) {
  const double needed = compliance_memory(mesh).most;
  const double free = free_memory();
  if (needed > free) {
    throw InputError(
        fmt::format("{}: what {} vertices do to each other takes {:.3g} GB while it is found, and "
                    "the machine has {:.3g} GB free; lower `cells`, or name fewer sides in `felt`",
                    mesh.name, mesh.tets.vertices.size(), 1e-9 * needed, 1e-9 * free));
  }
}

double stiffest_touch(const Compliance& body, double radius) {
  // The distance from a sampled vertex to the ball's axis is half a cell's diagonal at most, from
  // pressed vertices to the corners of the face a diagonal.
  const double diagonal = std::numbers::sqrt2 * body.mesh().spacing;
  return body.stiffest(std::max(radius, smallest_ball(body.mesh())) + 1.5 * diagonal);
}

std::shared_ptr<const Compliance> prepared(const SharedHapticMesh& mesh, const Tissue& tissue) {
  static PreparedBodies<Tissue, Compliance> bodies;
  return bodies.get({mesh, tissue}, [&] {
    check_tissue(*mesh, tissue);
    check_memory(*mesh);
    return std::make_shared<const Compliance>(first_alike(mesh), tissue);
  });
}

}  // namespace haptrial::deformable
