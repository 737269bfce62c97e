#pragma once

#include <cstdint>
#include <string_view>

namespace haptrial {

/// The 64-bit FNV-1a hash of what is added: the same on every machine, not for secrets.
class Fnv1a {
 public:
  constexpr Fnv1a& add(std::string_view bytes) noexcept {
    for (const char byte : bytes) {
      mix(static_cast<unsigned char>(byte));
    }
    return *this;
  }
  /// Adds the number's eight bytes, the lowest first.
  constexpr Fnv1a& add(std::uint64_t number) noexcept {
    for (int byte = 0; byte < 8; ++byte) {
      mix(number >> (8 * byte) & 0xffU);
    }
    return *this;
  }
  constexpr std::uint64_t value() const noexcept { return hash_; }

 private:
  constexpr void mix(std::uint64_t byte) noexcept { hash_ = (hash_ ^ byte) * 0x100000001b3U; }

  std::uint64_t hash_{0xcbf29ce484222325U};
};

constexpr std::uint64_t fnv1a(std::string_view text) noexcept { return Fnv1a().add(text).value(); }

}  // namespace haptrial
