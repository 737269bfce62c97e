#include "experiments/command/deform/deform_loads.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text/nearest.h"
#include "experiments/command/deform/session_loads.h"

namespace haptrial::experiments {

using deformable::SetupLoad;

std::vector<NamedLoad> loads_of(const DeformBody& body, const std::vector<std::string>& names) {
  std::vector<std::string> allowed;
  for (const SetupLoad& load : body.setup.loads) {
    allowed.push_back(load.name);
  }
  for (const std::string& name : names) {
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      throw InputError(not_allowed("the load", fmt::format("'{}'", name), allowed));
    }
  }
  if (allowed.empty()) {
    throw InputError(
        fmt::format("{}: there is no load; write [loads.NAME]", body.setup.file.string()));
  }
  std::vector<NamedLoad> loads;
  for (const SetupLoad& load : body.setup.loads) {
    if (!names.empty() && std::find(names.begin(), names.end(), load.name) == names.end()) {
      continue;
    }
    const deformable::LoadCase fixed = deformable::load_case_of(body.setup, load, body.mesh);
    if (load.session.empty()) {
      loads.push_back({load, fixed, false});
    } else {
      const auto touches = touches_of(body, load, fixed);
      loads.insert(loads.end(), touches.begin(), touches.end());
    }
  }
  for (const NamedLoad& load : loads) {
    deformable::check_load(body.mesh, load.load);
  }
  return loads;
}

}  // namespace haptrial::experiments
