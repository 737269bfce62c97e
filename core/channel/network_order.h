#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptrial::channel {

/// The word of four bytes that begins there, highest byte first, as instruments send it.
inline std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

}  // namespace haptrial::channel
