#include "core/record/read/check_phases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"

namespace haptrial::record {

void check_phases(const SessionReader& file, std::span<const Phase> known) {
  for (const PassRow& pass : file.passes()) {
    if (std::find(known.begin(), known.end(), pass.phase) == known.end()) {
      std::vector<std::string> names;
      for (const Phase& phase : known) {
        names.emplace_back(phase.name());
      }
      throw InputError(
          fmt::format("{}: the column phase of /trials has the unknown word '{}'; allowed: {}",
                      file.path().string(), pass.phase.name(), fmt::join(names, ", ")));
    }
  }
}

}  // namespace haptrial::record
