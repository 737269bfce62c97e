#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "core/record/byte_planes.h"

namespace haptrial::record {

/// @throws std::invalid_argument for a text above `bytes` or with a NUL byte.
void check_text(std::string_view text, std::size_t bytes, const char* what);

/// One packed row, written or read field by field in column order. Inside core/record only.
class PackedRow {
 public:
  explicit PackedRow(std::size_t bytes) : size_(bytes) {}
  PackedRow(const BytePlanes& planes, std::size_t at) : size_(planes.row_bytes()) {
    planes.get_row(at, bytes());
  }

  template <typename T>
  void put(T value) {
    std::memcpy(row_.data() + at_, &value, sizeof(T));
    at_ += sizeof(T);
  }
  void put_text(std::string_view text, std::size_t bytes, const char* what) {
    check_text(text, bytes, what);
    std::memcpy(row_.data() + at_, text.data(), text.size());
    at_ += bytes;
  }
  template <typename T>
  T get() {
    T value;
    std::memcpy(&value, row_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string get_text(std::size_t bytes) {
    const char* text = reinterpret_cast<const char*>(row_.data()) + at_;
    at_ += bytes;
    return {text, strnlen(text, bytes)};
  }
  std::span<std::uint8_t> bytes() { return {row_.data(), size_}; }

 private:
  std::array<std::uint8_t, 512> row_{};  // longer than any row of schema.h
  std::size_t size_;
  std::size_t at_{0};
};

}  // namespace haptrial::record
