#include "core/deformable/touch/prepared.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <list>
#include <mutex>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/deformable/touch/ball_touch.h"

namespace haptrial::deformable {
namespace {

using Made = std::shared_future<std::shared_ptr<const Compliance>>;

struct Entry {
  SharedFeltMesh mesh;
  Tissue tissue;
  Made made;
};

std::mutex& guard() {
  static std::mutex mutex;
  return mutex;
}

/// Those used last come first.
std::list<Entry>& entries() {
  static std::list<Entry> list;
  return list;
}

bool same_mesh(const FeltMesh& a, const FeltMesh& b) {
  return a.name == b.name && a.held == b.held && a.felt == b.felt &&
         std::ranges::equal(a.tets.tetrahedra, b.tets.tetrahedra) &&
         std::ranges::equal(a.tets.vertices, b.tets.vertices);
}

/// What the machine can give to a program that asks now [bytes].
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

}  // namespace

void check_memory(const FeltMesh& mesh) {
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
  // From a sampled vertex to the ball's axis is half a cell's diagonal at most, from what it
  // presses to the corners of the face a diagonal.
  const double diagonal = std::numbers::sqrt2 * body.mesh().spacing;
  return body.stiffest(std::max(radius, smallest_ball(body.mesh())) + 1.5 * diagonal);
}

std::shared_ptr<const Compliance> prepared(const SharedFeltMesh& mesh, const Tissue& tissue) {
  std::promise<std::shared_ptr<const Compliance>> promise;
  Made made;
  {
    const std::lock_guard lock(guard());
    std::list<Entry>& all = entries();
    const auto found = std::ranges::find_if(all, [&](const Entry& entry) {
      return entry.tissue == tissue && (entry.mesh == mesh || same_mesh(*entry.mesh, *mesh));
    });
    if (found != all.end()) {
      all.splice(all.begin(), all, found);
      made = found->made;
    } else {
      all.push_front({mesh, tissue, promise.get_future().share()});
      if (all.size() > kMostPrepared) {
        all.pop_back();
      }
    }
  }
  if (made.valid()) {
    return made.get();
  }
  try {
    check_tissue(*mesh, tissue);
    check_memory(*mesh);
    auto body = std::make_shared<const Compliance>(mesh, tissue);
    promise.set_value(body);
    return body;
  } catch (...) {
    promise.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace haptrial::deformable
