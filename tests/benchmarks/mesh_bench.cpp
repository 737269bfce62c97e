// Way from a surface to tetrahedra: Table 2 of the source repeated, beside what memory allows. One
// core; times are processor time of this thread, medians. With HAPTRIAL_DATA set to a folder that
// has meshes/, the Stanford bunny and dragon take part.
//
//     bench_mesh

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/mesh_check.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/support/shared_data.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace {

namespace geometry = haptrial::geometry;
using geometry::InsideRule;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// The median of the milliseconds that `work` takes.
template <class Work>
double milliseconds(int times, const Work& work) {
  std::vector<double> taken;
  for (int i = 0; i < times; ++i) {
    const double start = now();
    work();
    taken.push_back(now() - start);
  }
  std::nth_element(taken.begin(), taken.begin() + times / 2, taken.end());
  return taken[static_cast<std::size_t>(times / 2)];
}

struct Case {
  std::string name;
  geometry::Mesh mesh;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const std::vector<std::pair<const char*, const char*>> files{
      {"bunny, open", "stanford-bunny"},
      {"bunny, closed", "bunny_watertight_29k_fcpw"},
      {"dragon", "dragon_watertight_100k_fcpw"}};
  for (const auto& [name, stem] : files) {
    if (const auto file = haptrial::test::shared_data(fmt::format("meshes/{}.obj", stem))) {
      all.push_back({name, geometry::read_mesh(*file)});
    } else {
      fmt::print("{} takes no part: neither HAPTRIAL_DATA nor ../shared/data holds meshes/{}.obj\n",
                 name, stem);
    }
  }
  all.push_back({"gear", geometry::make_gear()});
  all.push_back({"torus", geometry::make_torus(0.05, 0.02, 160, 50)});
  all.push_back({"rough solid", geometry::make_rough_solid(0.1, 100, 1)});
  return all;
}

/// How fast this core writes memory that it has written before, past the caches [bytes/ms].
double write_speed(std::size_t bytes) {
  haptrial::BigArray<unsigned char> memory(bytes);
  const auto fill = [&] {
#ifdef __SSE2__
    const __m128i value = _mm_set1_epi8(1);
    for (std::size_t i = 0; i + 64 <= bytes; i += 64) {
      for (std::size_t part = 0; part < 64; part += 16) {
        _mm_stream_si128(reinterpret_cast<__m128i*>(memory.data() + i + part), value);
      }
    }
    _mm_sfence();
#else
    std::fill(memory.begin(), memory.end(), static_cast<unsigned char>(1));
#endif
  };
  fill();
  return static_cast<double>(bytes) / milliseconds(15, fill);
}

void run(const Case& one, int resolution) {
  const InsideRule rule = geometry::fitting_rule(one.mesh);
  const auto grid = geometry::make_grid(geometry::bounds(one.mesh), resolution);
  geometry::VoxelSolid solid;
  const double voxels = milliseconds(5, [&] { solid = geometry::voxelize(one.mesh, grid, rule); });
  double flood = 0.0;
  if (geometry::check_mesh(one.mesh).closed) {
    flood = milliseconds(3, [&] { geometry::voxelize(one.mesh, grid, InsideRule::kFlood); });
  }
  std::optional<geometry::TetMesh> mesh;
  const double fresh = milliseconds(5, [&] {
    mesh.reset();
    mesh = geometry::tetrahedralize(solid);
  });
  const double again = milliseconds(15, [&] { geometry::tetrahedralize(solid, *mesh); });
  const auto tets = static_cast<double>(mesh->tetrahedra.size());
  const double written = 25.0 * static_cast<double>(mesh->vertices.size()) + 16.0 * tets;
  const double least = written / write_speed(static_cast<std::size_t>(written));
  fmt::print("| {} | {} | {} | {} | {} | {:.2f} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} |\n",
             one.name, one.mesh.triangles.size(), resolution, geometry::count_inside(solid),
             mesh->tetrahedra.size(), voxels, flood > 0.0 ? fmt::format("{:.2f}", flood) : "-",
             fresh, again, least, 1e-3 * tets / again);
}

}  // namespace

int main() {
  fmt::print(
      "| mesh | triangles | long axis | voxels | tetrahedra | voxels ms | "
      "flood ms | tetrahedra ms, new memory | same memory | writing alone | million/s |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Case& one : cases()) {
    for (const int resolution : {30, 75, 135, 165}) {
      run(one, resolution);
    }
  }
}
