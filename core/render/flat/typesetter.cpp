#include "core/render/flat/typesetter.h"

#include <fmt/format.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangofc-font.h>
#include <pango/pangofc-fontmap.h>
#include <pango/pangoft2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace haptrial::render {
namespace {

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

struct FreeDescription {
  void operator()(PangoFontDescription* d) const { pango_font_description_free(d); }
};
struct FreeIterator {
  void operator()(PangoLayoutIter* i) const { pango_layout_iter_free(i); }
};

int pixels(int units) { return PANGO_PIXELS(units); }

/// Hinted as the pictures are (FT_LOAD_TARGET_LIGHT), so that widths are those of the pictures.
void hint_lightly(FcPattern* pattern, gpointer) {
  FcPatternDel(pattern, FC_HINTING);
  FcPatternAddBool(pattern, FC_HINTING, FcTrue);
  FcPatternDel(pattern, FC_HINT_STYLE);
  FcPatternAddInteger(pattern, FC_HINT_STYLE, FC_HINT_SLIGHT);
  FcPatternDel(pattern, FC_EMBEDDED_BITMAP);
  FcPatternAddBool(pattern, FC_EMBEDDED_BITMAP, FcFalse);
}

/// One for each thread, kept: looking for typefaces takes longer than everything else.
PangoFontMap* font_map() {
  thread_local const Owned<PangoFontMap> map = [] {
    Owned<PangoFontMap> made(pango_ft2_font_map_new());
    constexpr double kPointsPerInch = 72.0;
    pango_ft2_font_map_set_resolution(PANGO_FT2_FONT_MAP(made.get()), kPointsPerInch,
                                      kPointsPerInch);
    pango_fc_font_map_set_default_substitute(PANGO_FC_FONT_MAP(made.get()), &hint_lightly, nullptr,
                                             nullptr);
    return made;
  }();
  return map.get();
}

Owned<PangoLayout> layout_of(std::string_view text, int size, bool bold, int width) {
  if (size < 1) {
    throw std::invalid_argument(fmt::format("a text size is {}; allowed: from 1 px", size));
  }
  const Owned<PangoContext> context(pango_font_map_create_context(font_map()));
  Owned<PangoLayout> layout(pango_layout_new(context.get()));
  const std::unique_ptr<PangoFontDescription, FreeDescription> font(
      pango_font_description_from_string("DejaVu Sans,Noto Sans,sans-serif"));
  pango_font_description_set_absolute_size(font.get(), static_cast<double>(size) * PANGO_SCALE);
  pango_font_description_set_weight(font.get(), bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
  pango_layout_set_font_description(layout.get(), font.get());
  if (width > 0) {
    pango_layout_set_width(layout.get(), width * PANGO_SCALE);
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  }
  gchar* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  pango_layout_set_text(layout.get(), valid, -1);
  g_free(valid);
  return layout;
}

}  // namespace

struct Typesetter::Impl {
  using Key = std::tuple<std::string, int, bool, int>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      const auto& [text, size, bold, width] = key;
      return std::hash<std::string>()(text) ^ static_cast<std::size_t>(size * 8191 + width * 2) ^
             static_cast<std::size_t>(bold);
    }
  };
  Font regular{Font::sans()};
  Font bold{Font::sans_bold()};
  std::unordered_map<Key, std::vector<SetLine>, Hash> known;
  std::map<std::pair<std::string, int>, int> face_numbers;  // by file and its index
  std::vector<Font> faces;
  std::vector<std::string> files;  // (faces)

  int face_of(PangoFont* font, int& size);
  void add_run(const PangoLayoutRun& run, int& pen, SetLine& line);
  std::vector<SetLine> set(const Key& key);
};

/// The typeface that Pango chose. @param size  becomes the one in which it is drawn [px]
int Typesetter::Impl::face_of(PangoFont* font, int& size) {
  FcPattern* pattern = pango_fc_font_get_pattern(PANGO_FC_FONT(font));
  FcChar8* file = nullptr;
  int index = 0;
  double wanted = size;
  FcPatternGetString(pattern, FC_FILE, 0, &file);
  FcPatternGetInteger(pattern, FC_INDEX, 0, &index);
  FcPatternGetDouble(pattern, FC_PIXEL_SIZE, 0, &wanted);
  size = std::max(1, static_cast<int>(std::lround(wanted)));
  const std::pair name(std::string(reinterpret_cast<const char*>(file)), index);
  const auto [at, is_new] = face_numbers.emplace(name, static_cast<int>(faces.size()));
  if (is_new) {
    faces.emplace_back(name.first, name.second);
    files.push_back(name.first);
  }
  return at->second;
}

void Typesetter::Impl::add_run(const PangoLayoutRun& run, int& pen, SetLine& line) {
  int size = 1;
  const int face = face_of(run.item->analysis.font, size);
  for (int i = 0; i < run.glyphs->num_glyphs; ++i) {
    const PangoGlyphInfo& info = run.glyphs->glyphs[i];
    if (info.glyph != PANGO_GLYPH_EMPTY) {
      const bool unknown = (info.glyph & PANGO_GLYPH_UNKNOWN_FLAG) != 0;  // drawn as an empty box
      line.glyphs.push_back({face, unknown ? 0U : info.glyph, size,
                             pixels(pen + info.geometry.x_offset), pixels(info.geometry.y_offset)});
    }
    pen += info.geometry.width;
  }
}

std::vector<SetLine> Typesetter::Impl::set(const Key& key) {
  const auto& [text, size, is_bold, width] = key;
  const Owned<PangoLayout> layout = layout_of(text, size, is_bold, width);
  const std::unique_ptr<PangoLayoutIter, FreeIterator> at(pango_layout_get_iter(layout.get()));
  std::vector<SetLine> lines;
  do {
    const PangoLayoutLine* line = pango_layout_iter_get_line_readonly(at.get());
    lines.emplace_back();
    int pen = 0;
    for (const GSList* run = line->runs; run != nullptr; run = run->next) {
      add_run(*static_cast<const PangoLayoutRun*>(run->data), pen, lines.back());
    }
    lines.back().width = pixels(pen);
  } while (pango_layout_iter_next_line(at.get()) != FALSE);
  return lines;
}

Typesetter::Typesetter() : impl_(std::make_unique<Impl>()) {}
Typesetter::~Typesetter() = default;

const std::vector<SetLine>& Typesetter::lines(std::string_view text, int size, bool bold,
                                              int width) {
  constexpr std::size_t kMost = 4096;  // changing numbers must not fill the memory
  Impl::Key key(text, size, bold, width);
  if (const auto known = impl_->known.find(key); known != impl_->known.end()) {
    return known->second;
  }
  if (impl_->known.size() >= kMost) {
    impl_->known.clear();
  }
  std::vector<SetLine> lines = impl_->set(key);
  return impl_->known.emplace(std::move(key), std::move(lines)).first->second;
}

Glyph Typesetter::glyph(const SetGlyph& glyph) {
  return impl_->faces.at(static_cast<std::size_t>(glyph.face)).glyph(glyph.index, glyph.size);
}

const std::string& Typesetter::file_of(int face) const {
  return impl_->files.at(static_cast<std::size_t>(face));
}

int Typesetter::ascent(int size, bool bold) const {
  return (bold ? impl_->bold : impl_->regular).ascent(size);
}

int Typesetter::line_height(int size, bool bold) const {
  return (bold ? impl_->bold : impl_->regular).line_height(size);
}

std::vector<char32_t> missing_characters(std::string_view text) {
  constexpr int kAnySize = 20;
  const Owned<PangoLayout> layout = layout_of(text, kAnySize, false, 0);
  const std::unique_ptr<PangoLayoutIter, FreeIterator> at(pango_layout_get_iter(layout.get()));
  std::vector<char32_t> missing;
  do {
    const PangoLayoutRun* run = pango_layout_iter_get_run_readonly(at.get());
    for (int i = 0; run != nullptr && i < run->glyphs->num_glyphs; ++i) {
      const PangoGlyph glyph = run->glyphs->glyphs[i].glyph;
      const auto character = static_cast<char32_t>(glyph & ~PANGO_GLYPH_UNKNOWN_FLAG);
      if ((glyph & PANGO_GLYPH_UNKNOWN_FLAG) != 0 && glyph != PANGO_GLYPH_EMPTY &&
          std::find(missing.begin(), missing.end(), character) == missing.end()) {
        missing.push_back(character);
      }
    }
  } while (pango_layout_iter_next_run(at.get()) != FALSE);
  return missing;
}

}  // namespace haptrial::render
