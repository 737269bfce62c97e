#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace haptrial::record {

/// "812 of 950 ticks (85.5 %) overran their period" where more than one tick in a hundred did. Each
/// gives its force late; beyond that share the readings from which velocity is estimated are no
/// longer even, and damping is not what the definition says.
std::optional<std::string> too_many_overruns(std::uint64_t ticks, std::uint64_t overruns);

}  // namespace haptrial::record
