#include "core/record/read/overruns.h"

#include <fmt/format.h>

namespace haptrial::record {

std::optional<std::string> too_many_overruns(std::uint64_t ticks, std::uint64_t overruns) {
  constexpr double kMost = 0.01;
  if (static_cast<double>(overruns) <= kMost * static_cast<double>(ticks)) {
    return std::nullopt;
  }
  return fmt::format("{} of {} ticks ({:.1f} %) overran their period", overruns, ticks,
                     100.0 * static_cast<double>(overruns) / static_cast<double>(ticks));
}

}  // namespace haptrial::record
