#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace haptrial::geometry {

/// A file that is written whole or not at all: the bytes go to FILE.partial-N beside it, which
/// takes its name in finish(). Without that, or when the program is told to stop, nothing is left.
class OutputFile {
 public:
  /// @param overwrite  replace a file that is there
  /// @throws InputError where the file is there or cannot be made.
  explicit OutputFile(std::filesystem::path file, bool overwrite = false);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// @throws RunError in the words of the system, as on a full disk.
  void write(std::string_view bytes);
  template <class T>
  void write_all(std::span<const T> values) {
    write({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }
  void finish();

  /// The file under its present name, for libraries that open it themselves.
  const std::filesystem::path& part() const { return part_; }
  /// Lets another writer have the part; finish() then only gives it its name.
  void release();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path file_;
  std::filesystem::path part_;
  bool overwrite_;
  bool finished_{false};
  std::FILE* stream_{nullptr};
};

}  // namespace haptrial::geometry
