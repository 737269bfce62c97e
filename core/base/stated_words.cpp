#include "core/base/stated_words.h"

#include <algorithm>
#include <cstdint>
#include <locale>
#include <stdexcept>

#include "core/base/utf8.h"

namespace haptrial {
namespace {

/// Knows the letters of every alphabet; those of English alone on a system without the locale.
const std::locale& letters() {
  static const std::locale known = [] {
    try {
      return std::locale("C.UTF-8");
    } catch (const std::runtime_error&) {
      return std::locale::classic();
    }
  }();
  return known;
}

/// The number of a character in Unicode; a byte that is not UTF-8 stands for itself.
wchar_t character_number(std::string_view character) {
  auto number = static_cast<unsigned char>(character.front()) & 0xffU;
  if (character.size() > 1) {
    number &= 0x7fU >> character.size();
    for (const char byte : character.substr(1)) {
      number = number << 6U | (static_cast<unsigned char>(byte) & 0x3fU);
    }
  }
  return static_cast<wchar_t>(number);
}

std::wstring small_letters(std::string_view text) {
  std::wstring small;
  while (!text.empty()) {
    const std::string_view next = text.substr(0, character_bytes(text.front()));
    const std::string_view character = !next.empty() && is_utf8(next) ? next : text.substr(0, 1);
    small += std::tolower(character_number(character), letters());
    text.remove_prefix(character.size());
  }
  return small;
}

/// Scripts that are written without spaces between words.
bool is_unspaced(wchar_t letter) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr Range kUnspaced[] = {
      {0x0E00, 0x0EFF},    // Thai, Lao
      {0x1000, 0x109F},    // Myanmar
      {0x1780, 0x17FF},    // Khmer
      {0x3005, 0x3007},    // marks among Han characters
      {0x3040, 0x30FF},    // Hiragana, Katakana
      {0x31F0, 0x31FF},    // Katakana
      {0x3400, 0x4DBF},    // Han
      {0x4E00, 0x9FFF},    // Han
      {0xF900, 0xFAFF},    // Han
      {0xFF66, 0xFF9F},    // Katakana of half width
      {0x20000, 0x3FFFF},  // Han
  };
  const auto number = static_cast<std::uint32_t>(letter);
  return std::ranges::any_of(kUnspaced, [number](const Range& range) {
    return number >= range.first && number <= range.last;
  });
}

/// Whether two characters in a row may be of one word.
bool joins(wchar_t before, wchar_t after) {
  const auto continues = [](wchar_t character) {
    return std::isalnum(character, letters()) && !is_unspaced(character);
  };
  return continues(before) && continues(after);
}

}  // namespace

bool has_stated_word(std::string_view text, std::string_view word) {
  const std::wstring all = small_letters(text), wanted = small_letters(word);
  for (auto at = all.find(wanted); !wanted.empty() && at != std::wstring::npos;
       at = all.find(wanted, at + 1)) {
    const std::size_t end = at + wanted.size();
    if ((at == 0 || !joins(all[at - 1], all[at])) &&
        (end == all.size() || !joins(all[end - 1], all[end]))) {
      return true;
    }
  }
  return false;
}

}  // namespace haptrial
