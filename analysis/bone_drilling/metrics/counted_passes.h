#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::analysis::drilling {

struct CountedPass {
  std::size_t row;  // of /passes
  record::PassRow pass;
};

/// The passes of each trial of a drilling session that count, by trial: those of practice are left
/// out, and of a drilling that was begun anew on a fresh bone those on earlier bones.
/// @throws InputError where the file is damaged
std::map<std::int32_t, std::vector<CountedPass>> counted_passes(const record::SessionReader& file);

}  // namespace haptrial::analysis::drilling
