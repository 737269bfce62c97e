#pragma once

#include <cstddef>
#include <string_view>

namespace haptrial {

/// Whether the byte is one of a UTF-8 character and not its first.
constexpr bool continues_character(char byte) noexcept {
  return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80U;
}

/// The bytes of a UTF-8 character that starts with this one; 0 where none starts so.
constexpr std::size_t character_bytes(char first) noexcept {
  const auto byte = static_cast<unsigned char>(first);
  if (byte < 0x80) {
    return 1;
  }
  if (byte >= 0xc2 && byte < 0xe0) {
    return 2;
  }
  if (byte >= 0xe0 && byte < 0xf0) {
    return 3;
  }
  return byte >= 0xf0 && byte < 0xf5 ? 4 : 0;
}

/// Whether the text consists of characters of UTF-8.
constexpr bool is_utf8(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text.front());
    if (bytes == 0 || bytes > text.size()) {
      return false;
    }
    for (std::size_t i = 1; i < bytes; ++i) {
      if (!continues_character(text[i])) {
        return false;
      }
    }
    text.remove_prefix(bytes);
  }
  return true;
}

/// The most bytes, up to `most`, after which `text` can be cut without dividing a UTF-8 character.
/// A text that is not UTF-8 there is cut after `most` bytes.
constexpr std::size_t whole_characters(std::string_view text, std::size_t most) noexcept {
  if (most >= text.size()) {
    return text.size();
  }
  constexpr std::size_t kContinuations = 3;  // at most, in one character
  std::size_t cut = most;
  while (cut > 0 && most - cut < kContinuations && continues_character(text[cut])) {
    --cut;
  }
  return continues_character(text[cut]) ? most : cut;
}

/// The text up to `most` bytes, ending with a whole character.
constexpr std::string_view cut_text(std::string_view text, std::size_t most) noexcept {
  return text.substr(0, whole_characters(text, most));
}

}  // namespace haptrial
