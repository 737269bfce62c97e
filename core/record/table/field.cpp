#include "core/record/table/field.h"

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

Field number_field(const char* name, std::size_t offset, MemberType type, const char* unit,
                   const char* description) {
  const auto field = [&](ColumnType column, std::size_t bytes) -> Field {
    return {{name, column, bytes, unit, description}, offset, type};
  };
  switch (type) {
    case MemberType::kI32:
    case MemberType::kU32:
      return field(ColumnType::kI32, 4);
    case MemberType::kI64:
      return field(ColumnType::kI64, 8);
    case MemberType::kU64:
      return field(ColumnType::kU64, 8);
    case MemberType::kF32:
      return field(ColumnType::kF32, 4);
    case MemberType::kF64:
      return field(ColumnType::kF64, 8);
    case MemberType::kBool:
    case MemberType::kU8:
    case MemberType::kText:
    case MemberType::kName:
      break;
  }
  return field(ColumnType::kU8, 1);
}

Field real32_field(const char* name, std::size_t offset, const char* unit, const char* description,
                   double resolution) {
  return {{name, ColumnType::kF32, 4, unit, description, resolution}, offset, MemberType::kF64};
}

Field text_field(const char* name, std::size_t offset, std::size_t bytes, const char* description) {
  return {{name, ColumnType::kText, bytes, "", description}, offset, MemberType::kText};
}

Field name_field(const char* name, std::size_t offset, std::size_t bytes, const char* description) {
  return {{name, ColumnType::kText, bytes, "", description}, offset, MemberType::kName};
}

Field word_field(const char* name, std::size_t offset, std::size_t bytes, EnumText words,
                 const char* description) {
  return {
      {name, ColumnType::kText, bytes, "", description}, offset, MemberType::kU8, std::move(words)};
}

Field code_field(const char* name, std::size_t offset, EnumText words, const char* description) {
  return {{name, ColumnType::kU8, 1, "1", description}, offset, MemberType::kU8, std::move(words)};
}

}  // namespace haptrial::record
