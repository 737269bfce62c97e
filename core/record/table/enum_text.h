#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace haptrial::record
