#pragma once

#include <cstddef>
#include <cstdint>

#include "core/record/table/enum_text.h"
#include "core/record/table/schema.h"

namespace haptrial::record {

/// Type of a row's member in memory. A bool or an enumeration takes one byte; a name is as many
/// characters as its column, the last one 0.
enum class MemberType : std::uint8_t {
  kBool,
  kU8,
  kI32,
  kU32,
  kI64,
  kU64,
  kF32,
  kF64,
  kText,
  kName
};

/// One column and the member of the row that it holds.
struct Field {
  Column column{};
  std::size_t offset{0};  // of the member in the row [bytes]
  MemberType member{MemberType::kU8};
  EnumText words{};       // of an enumeration
  std::int64_t since{1};  // schema version from which on files have the column
};

/// Fields by what the column is; for Table<Row>.
Field number_field(const char* name, std::size_t offset, MemberType type, const char* unit,
                   const char* description);
Field real32_field(const char* name, std::size_t offset, const char* unit, const char* description,
                   double resolution);
Field text_field(const char* name, std::size_t offset, std::size_t bytes, const char* description);
Field name_field(const char* name, std::size_t offset, std::size_t bytes, const char* description);
Field word_field(const char* name, std::size_t offset, std::size_t bytes, EnumText words,
                 const char* description);
Field code_field(const char* name, std::size_t offset, EnumText words, const char* description);

}  // namespace haptrial::record
