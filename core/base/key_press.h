#pragma once

namespace haptrial {

/// A key of a window that went down, or a character that was typed: these follow the keys that make
/// them up, and a key that is held types one. Keys of characters are the capital character that the
/// keyboard's layout gives them, 'P' or '1'; the number pad's digits and Enter are like the others.
struct KeyPress {
  static constexpr int kEscape = 256;
  static constexpr int kEnter = 257;
  static constexpr int kSpace = ' ';
  static constexpr int kBackspace = 259;
  static constexpr int kRight = 262;
  static constexpr int kLeft = 263;
  static constexpr int kDown = 264;
  static constexpr int kUp = 265;
  static constexpr int kOther = 0;
  int key{kOther};
  char32_t character{0};  // that was typed; 0: a key
  bool operator==(const KeyPress&) const = default;
};

}  // namespace haptrial
