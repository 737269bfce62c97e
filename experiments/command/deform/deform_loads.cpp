#include "experiments/command/deform/deform_loads.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "experiments/command/deform/session_loads.h"

namespace haptrial::experiments {

using deformable::SetupLoad;

namespace {

/// A force on what is held moves nothing.
void check_moves(const geometry::TetMesh& mesh, const deformable::LoadCase& load) {
  const auto held = deformable::held_flags(mesh.vertices.size(), load.holds);
  const bool moves =
      std::ranges::any_of(load.holds,
                          [](const auto& hold) { return !hold.displacement.isZero(0); }) ||
      std::ranges::any_of(load.forces, [&](const auto& nodal) {
        return held[static_cast<std::size_t>(nodal.vertex)] == 0 && !nodal.force.isZero(0);
      });
  if (!moves) {
    throw InputError(fmt::format(
        "load '{}' moves no vertex, and has no force on one that is not held", load.name));
  }
}

}  // namespace

std::vector<NamedLoad> loads_of(const DeformBody& body, const std::vector<std::string>& names) {
  std::vector<std::string> allowed;
  for (const SetupLoad& load : body.setup.loads) {
    allowed.push_back(load.name);
  }
  if (allowed.empty()) {
    throw InputError(
        fmt::format("{}: there is no load; write [loads.NAME]", body.setup.file.string()));
  }
  std::vector<NamedLoad> loads;
  for (const SetupLoad& load : body.setup.loads) {
    const auto meant = [&](const std::string& name) {  // a load, or one touch of a session's
      return name == load.name || (!load.session.empty() && name.starts_with(load.name + " "));
    };
    if (!names.empty() && std::ranges::none_of(names, meant)) {
      continue;
    }
    const deformable::LoadCase fixed = deformable::load_case_of(body.setup, load, body.mesh);
    if (load.session.empty()) {
      loads.push_back({load, fixed, false});
    } else {
      const bool all = names.empty() || std::ranges::find(names, load.name) != names.end();
      for (NamedLoad& touch : touches_of(body, load, fixed)) {
        allowed.push_back(touch.load.name);
        if (all || std::ranges::find(names, touch.load.name) != names.end()) {
          loads.push_back(std::move(touch));
        }
      }
    }
  }
  for (const std::string& name : names) {
    if (std::ranges::find(allowed, name) == allowed.end()) {
      throw InputError(not_allowed("the load", fmt::format("'{}'", name), allowed));
    }
  }
  for (const NamedLoad& load : loads) {
    deformable::check_load(body.mesh, load.load);
    check_moves(body.mesh, load.load);
  }
  return loads;
}

}  // namespace haptrial::experiments
