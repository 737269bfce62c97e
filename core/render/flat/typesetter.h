#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/render/flat/font.h"

namespace haptrial::render {

/// A glyph of a typeface where it belongs in its line.
struct SetGlyph {
  int face{0};             // of Typesetter::glyph()
  std::uint32_t index{0};  // of the glyph in the typeface
  int size{0};             // [px]
  int x{0};                // of the pen, from the line's left end [px]
  int y{0};                // of the pen, from the baseline down [px]
};

/// A line as it is seen, from left to right.
struct SetLine {
  std::vector<SetGlyph> glyphs;
  int width{0};  // [px]
};

/// Sets text of any script in lines (Pango, HarfBuzz): letters joined, reordered and combined,
/// lines from right to left where the script runs so, characters that DejaVu Sans lacks from the
/// typefaces that the machine has. Lines that were set before come from memory.
/// One thread; each thread has typefaces of its own. Never the servo thread.
class Typesetter {
 public:
  /// @throws RunError when DejaVu Sans is missing.
  Typesetter();
  ~Typesetter();
  Typesetter(const Typesetter&) = delete;
  Typesetter& operator=(const Typesetter&) = delete;

  /// @param text   UTF-8; each byte that belongs to no character becomes U+FFFD
  /// @param size   of the em square >= 1 [px]
  /// @param width  wrapped between words, or within one that is wider [px]; 0: only at line breaks
  /// @returns lines that are valid until the next call
  const std::vector<SetLine>& lines(std::string_view text, int size, bool bold, int width);

  /// The picture of a glyph that lines() names.
  Glyph glyph(const SetGlyph& glyph);
  /// The file of a typeface. @param face  of a SetGlyph
  const std::string& file_of(int face) const;
  int ascent(int size, bool bold) const;       // [px]
  int line_height(int size, bool bold) const;  // from baseline to baseline [px]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The characters of a text that no typeface of this machine has, each once.
std::vector<char32_t> missing_characters(std::string_view text);

}  // namespace haptrial::render
