#include "core/base/stated_words.h"

#include <algorithm>
#include <locale>
#include <stdexcept>
#include <string>

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

}  // namespace

bool has_stated_word(std::string_view text, std::string_view word) {
  const std::wstring all = small_letters(text), wanted = small_letters(word);
  const auto joins = [&](std::size_t at) { return std::isalnum(all[at], letters()); };
  for (auto at = all.find(wanted); !wanted.empty() && at != std::wstring::npos;
       at = all.find(wanted, at + 1)) {
    const std::size_t end = at + wanted.size();
    if ((at == 0 || !joins(at - 1)) && (end == all.size() || !joins(end))) {
      return true;
    }
  }
  return false;
}

}  // namespace haptrial
