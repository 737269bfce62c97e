#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/base/utf8.h"

namespace haptrial::questions {

/// Most bytes of a typed answer.
inline constexpr std::size_t kTextBytes = 1000;

/// A text that is being typed, in UTF-8. Plain data of a fixed size; all functions may be called on
/// the servo thread: no allocation, lock, I/O or throw.
class TypedText {
 public:
  std::string_view view() const noexcept { return {bytes_.data(), size_}; }
  bool empty() const noexcept { return size_ == 0; }
  void clear() noexcept { size_ = 0; }
  /// Takes as many whole characters of the text as there is room for.
  void set(std::string_view text) noexcept {
    const std::string_view fits = cut_text(text, kTextBytes);
    size_ = 0;
    append(fits);
  }
  /// @returns false, with nothing added, if a character has no room
  bool append(char32_t c) noexcept {
    const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
    const std::array<char, 4> all =
        c < 0x80    ? std::array<char, 4>{byte(c)}
        : c < 0x800 ? std::array<char, 4>{byte(0xc0 | (c >> 6)), byte(0x80 | (c & 0x3f))}
        : c < 0x10000
            ? std::array<char, 4>{byte(0xe0 | (c >> 12)), byte(0x80 | ((c >> 6) & 0x3f)),
                                  byte(0x80 | (c & 0x3f))}
            : std::array<char, 4>{byte(0xf0 | (c >> 18)), byte(0x80 | ((c >> 12) & 0x3f)),
                                  byte(0x80 | ((c >> 6) & 0x3f)), byte(0x80 | (c & 0x3f))};
    const std::size_t bytes = c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
    return append(std::string_view(all.data(), bytes));
  }
  /// @returns false if nothing was typed
  bool remove_last() noexcept {
    const bool some = size_ > 0;
    size_ = some ? whole_characters(view(), size_ - 1) : 0;
    return some;
  }

 private:
  bool append(std::string_view bytes) noexcept {
    if (size_ + bytes.size() > kTextBytes) {
      return false;
    }
    for (const char each : bytes) {
      bytes_[size_++] = each;
    }
    return true;
  }

  std::array<char, kTextBytes> bytes_{};
  std::size_t size_{0};
};

}  // namespace haptrial::questions
