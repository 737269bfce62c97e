#include "core/record/table/enum_text.h"

#include <algorithm>

namespace haptrial::record {

const char* EnumText::word_of(std::uint8_t value) const {
  const auto at = std::find_if(entries_.begin(), entries_.end(),
                               [value](const Entry& entry) { return entry.value == value; });
  return at != entries_.end() ? at->word : nullptr;
}

const EnumText::Entry* EnumText::find(std::string_view word) const {
  const auto at = std::find_if(entries_.begin(), entries_.end(),
                               [word](const Entry& entry) { return word == entry.word; });
  return at != entries_.end() ? &*at : nullptr;
}

std::string EnumText::list() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += (text.empty() ? "" : ", ") + std::string(entry.word);
  }
  return text;
}

std::string EnumText::numbered() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += (text.empty() ? "" : ", ") + std::to_string(entry.value) + " " + entry.word;
  }
  return text;
}

}  // namespace haptrial::record
