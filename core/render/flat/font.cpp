#include "core/render/flat/font.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

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

Font::Font(const std::filesystem::path& file, long number) : impl_(std::make_unique<Impl>()) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) {
    throw RunError("FreeType cannot be started, so no text can be drawn");
  }
  impl_->library.reset(library);
  FT_Face face = nullptr;
  if (FT_New_Face(library, file.c_str(), number, &face) != 0) {
    throw RunError(fmt::format("{}: absent or not a typeface that FreeType reads", file.string()));
  }
  impl_->face.reset(face);
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

Font Font::sans() { return debian_font("DejaVuSans.ttf"); }
Font Font::sans_bold() { return debian_font("DejaVuSans-Bold.ttf"); }

std::uint32_t Font::index_of(char32_t character) const {
  return FT_Get_Char_Index(impl_->face.get(), character);
}

Glyph Font::glyph(std::uint32_t index, int size) const {
  impl_->use(size);
  if (FT_Load_Glyph(impl_->face.get(), index, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) {
    throw RunError(
        fmt::format("FreeType cannot draw glyph {} of {}", index, impl_->face->family_name));
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

int Font::ascent(int size) const {
  impl_->use(size);
  return rounded(impl_->face->size->metrics.ascender);
}

int Font::line_height(int size) const {
  impl_->use(size);
  return rounded(impl_->face->size->metrics.height);
}

}  // namespace haptrial::render
