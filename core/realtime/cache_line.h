#pragma once

#include <cstddef>

namespace haptrial::realtime {

inline constexpr std::size_t kCacheLineBytes = 64;

/// Distance between data that different threads write: two lines, because processors fetch lines in
/// pairs. Not std::hardware_destructive_interference_size, whose value is part of no stable ABI.
inline constexpr std::size_t kSeparation = 2 * kCacheLineBytes;

}  // namespace haptrial::realtime
