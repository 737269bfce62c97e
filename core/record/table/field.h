#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/record/table/schema.h"

namespace haptrial::record {

/// A file holds what no column of its table may hold: a word or a number that stands for nothing.
/// what() names the table, the column, what was found and what is allowed; the callers add the
/// file.
class UnknownWord : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The words of a file for the values of an enumeration, each once.
class EnumText {
 public:
  struct Entry {
    std::uint8_t value;
    const char* word;
  };
  EnumText() = default;
  explicit EnumText(std::vector<Entry> entries) : entries_(std::move(entries)) {}

  const std::vector<Entry>& entries() const { return entries_; }
  bool empty() const { return entries_.empty(); }
  /// nullptr if there is none.
  const char* word_of(std::uint8_t value) const;
  /// nullptr if it is no word of these.
  const Entry* find(std::string_view word) const;
  bool has(std::uint8_t value) const { return word_of(value) != nullptr; }
  /// "training, test, drilling"
  std::string list() const;
  /// "0 idle, 1 approach"
  std::string numbered() const;

 private:
  std::vector<Entry> entries_;
};

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
