#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace haptrial::record {

/// Runs `work` in a process of its own, which may crash or not come back, and returns what it said;
/// nothing where it did not come to its end within ten seconds a gigabyte begun, or threw.
/// @param bytes  that it reads
std::optional<std::string> in_a_process_of_its_own(std::uint64_t bytes,
                                                   const std::function<std::string()>& work);

}  // namespace haptrial::record
