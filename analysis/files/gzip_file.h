#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace haptrial::exchange {

/// Writes a gzip file (RFC 1952) piece by piece: every megabyte of text is a member of its own, and
/// a reader sees one text. Memory does not grow with the file. One thread at a time.
class GzipFile {
 public:
  /// @throws RunError when the file cannot be made.
  explicit GzipFile(const std::filesystem::path& path);
  ~GzipFile();  // without close() the file is cut short
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  /// @throws RunError when the disk is full.
  void write(std::string_view text);
  void close();

  static constexpr std::size_t kMember = std::size_t{1} << 20;  // [bytes of text]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::exchange
