#include "core/render/flat/font.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/text/utf8.h"

namespace haptrial::render {
namespace {

constexpr char32_t kReplacement = 0xfffd;
constexpr FT_Pos kUnit = 64;  // FreeType counts in 1/64 px

struct CloseLibrary {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
};
struct CloseFace {
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};

int rounded(FT_Pos length) { return static_cast<int>((length + kUnit / 2) / kUnit); }

Font debian_font(const char* name) {
  const std::filesystem::path file =
      std::filesystem::path("/usr/share/fonts/truetype/dejavu") / name;
  if (!std::filesystem::exists(file)) {
    throw RunError(
        fmt::format("the typeface {} is missing; install Debian's package "
                    "fonts-dejavu-core",
                    file.string()));
  }
  return Font(file);
}

}  // namespace

struct Font::Impl {
  std::unique_ptr<FT_LibraryRec_, CloseLibrary> library;
  std::unique_ptr<FT_FaceRec_, CloseFace> face;  // goes before the library
  int size{0};

  void use(int wanted) {
    if (wanted < 1) {
      throw std::invalid_argument(fmt::format("a text size is {}; allowed: from 1 px", wanted));
    }
    if (wanted != size) {
      FT_Set_Pixel_Sizes(face.get(), 0, static_cast<FT_UInt>(wanted));
      size = wanted;
    }
  }
};

Font::Font(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) {
    throw RunError("FreeType cannot be started, so no text can be drawn");
  }
  impl_->library.reset(library);
  FT_Face face = nullptr;
  if (FT_New_Face(library, file.c_str(), 0, &face) != 0) {
    throw RunError(fmt::format("{}: absent or not a typeface that FreeType reads", file.string()));
  }
  impl_->face.reset(face);
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

Font Font::sans() { return debian_font("DejaVuSans.ttf"); }
Font Font::sans_bold() { return debian_font("DejaVuSans-Bold.ttf"); }

Glyph Font::glyph(char32_t character, int size) const {
  impl_->use(size);
  // Index 0, for a character that is not there, is the box.
  const FT_UInt index = FT_Get_Char_Index(impl_->face.get(), character);
  if (FT_Load_Glyph(impl_->face.get(), index, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) {
    throw RunError(fmt::format("FreeType cannot draw the character U+{:04X}",
                               static_cast<unsigned>(character)));
  }
  const FT_GlyphSlot slot = impl_->face->glyph;
  const FT_Bitmap& bitmap = slot->bitmap;
  Glyph glyph{slot->bitmap_left,
              slot->bitmap_top,
              static_cast<int>(bitmap.width),
              static_cast<int>(bitmap.rows),
              rounded(slot->advance.x),
              {}};
  glyph.coverage.resize(std::size_t{bitmap.width} * bitmap.rows);
  for (unsigned row = 0; row < bitmap.rows; ++row) {
    std::copy_n(bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch, bitmap.width,
                glyph.coverage.begin() + static_cast<std::ptrdiff_t>(row * bitmap.width));
  }
  return glyph;
}

bool Font::has(char32_t character) const {
  return FT_Get_Char_Index(impl_->face.get(), character) != 0;
}

int Font::kerning(char32_t left, char32_t right, int size) const {
  impl_->use(size);
  FT_Vector shift{};
  FT_Get_Kerning(impl_->face.get(), FT_Get_Char_Index(impl_->face.get(), left),
                 FT_Get_Char_Index(impl_->face.get(), right), FT_KERNING_DEFAULT, &shift);
  return static_cast<int>(shift.x / kUnit);
}

int Font::ascent(int size) const {
  impl_->use(size);
  return rounded(impl_->face->size->metrics.ascender);
}

int Font::line_height(int size) const {
  impl_->use(size);
  return rounded(impl_->face->size->metrics.height);
}

namespace {

/// The character of a whole, well-formed sequence; U+FFFD for anything else.
char32_t character_of(std::string_view bytes) {
  constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  char32_t value = static_cast<unsigned char>(bytes.front());
  if (bytes.size() == 1) {
    return value;
  }
  value &= 0xffu >> (bytes.size() + 1);
  for (const char byte : bytes.substr(1)) {
    if (!continues_character(byte)) {
      return kReplacement;
    }
    value = (value << 6) | (static_cast<unsigned char>(byte) & 0x3fu);
  }
  const bool surrogate = value >= 0xd800 && value < 0xe000;
  return value < kSmallest[bytes.size()] || value > 0x10ffff || surrogate ? kReplacement : value;
}

}  // namespace

std::u32string decode_utf8(std::string_view text) {
  std::u32string characters;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_bytes(text[i]);
    const bool whole = length > 0 && i + length <= text.size();
    const char32_t character = whole ? character_of(text.substr(i, length)) : kReplacement;
    characters.push_back(character);
    i += whole && character != kReplacement ? length : 1;
  }
  return characters;
}

}  // namespace haptrial::render
