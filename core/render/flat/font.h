#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace haptrial::render {

/// The picture of one glyph at one size.
struct Glyph {
  int left{0};                         // from the pen to the picture's left edge [px]
  int top{0};                          // from the baseline up to its top edge [px]
  int width{0};                        // [px]
  int height{0};                       // [px]
  int advance{0};                      // to the next pen position [px]
  std::vector<std::uint8_t> coverage;  // (height x width), 0 to 255
};

/// Draws glyphs of a typeface (FreeType). Not thread-safe.
class Font {
 public:
  /// @param face  of the file's typefaces, from 0
  /// @throws RunError when the file is absent or holds no typeface.
  explicit Font(const std::filesystem::path& file, long face = 0);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  /// DejaVu Sans, which Debian's package fonts-dejavu-core brings.
  /// @throws RunError naming the package when it is absent.
  static Font sans();
  static Font sans_bold();

  /// The glyph of a character; 0, an empty box, if the typeface lacks it.
  std::uint32_t index_of(char32_t character) const;
  /// @param size  height of the em square >= 1 [px]
  Glyph glyph(std::uint32_t index, int size) const;
  int ascent(int size) const;       // of the tallest letters over the baseline [px]
  int line_height(int size) const;  // from baseline to baseline [px]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::render
