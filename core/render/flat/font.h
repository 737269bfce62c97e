#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::render {

/// The picture of one character at one size.
struct Glyph {
  int left{0};                         // from the pen to the picture's left edge [px]
  int top{0};                          // from the baseline up to its top edge [px]
  int width{0};                        // [px]
  int height{0};                       // [px]
  int advance{0};                      // to the next pen position [px]
  std::vector<std::uint8_t> coverage;  // (height x width), 0 to 255
};

/// Draws characters of a typeface (FreeType). Not thread-safe.
class Font {
 public:
  /// @throws RunError when the file is absent or holds no typeface.
  explicit Font(const std::filesystem::path& file);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  /// DejaVu Sans, which Debian's package fonts-dejavu-core brings.
  /// @throws RunError naming the package when it is absent.
  static Font sans();
  static Font sans_bold();

  /// A character that the typeface lacks is drawn as an empty box.
  /// @param size  height of the em square >= 1 [px]
  Glyph glyph(char32_t character, int size) const;
  bool has(char32_t character) const;
  /// What is added to the pen between two characters [px].
  int kerning(char32_t left, char32_t right, int size) const;
  int ascent(int size) const;       // of the tallest letters over the baseline [px]
  int line_height(int size) const;  // from baseline to baseline [px]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The characters of a UTF-8 text; each byte that belongs to none becomes U+FFFD.
std::u32string decode_utf8(std::string_view text);

}  // namespace haptrial::render
